//! Attributes: the text of a table in, the table out.

use super::check::{NAME_MAX, is_attribute_name};
use super::field::{Object, choice, integer32, real32};
use super::json::{Found, Value};
use crate::attribute::{Attribute, AttributeFormat, AttributeTable, COMPONENTS_MAX};

/// A command's id, table and whether it is resident.
pub(crate) fn attributes(value: Value<'_>) -> Found<(u32, AttributeTable, bool)> {
    let object = Object::read(value, &["id", "layout", "values", "resident"])?;
    let id = integer32(object.require("id", "an integer that draws name")?, 0, u32::MAX)?;
    let resident = object.get("resident").map(super::field::flag).transpose()?.unwrap_or(false);
    let layout = layout(object.require("layout", "an array of attributes")?)?;
    let rows = object.require("values", "an array of numbers a corner")?;
    Ok((id, AttributeTable { values: values(rows, &layout)?, layout }, resident))
}

fn layout(list: Value<'_>) -> Found<Vec<Attribute>> {
    let mut layout: Vec<Attribute> = Vec::new();
    let mut components = 0;
    list.elements("an array of attributes", |_, value| {
        let object = Object::read(value, &["name", "format"])?;
        let key = object.require("name", "the attribute's name")?;
        let name = key.string("a name")?.into_owned();
        if !is_attribute_name(&name) {
            return Err(key.expected(format_args!(
                "letters, digits and underscores, not starting with a digit, at most {NAME_MAX}"
            )));
        }
        if layout.iter().any(|a| a.name == name) {
            return Err(key.expected("a name that no other attribute of the layout has"));
        }
        let formats: Vec<_> = AttributeFormat::ALL.iter().map(|f| (f.name(), *f)).collect();
        let format = choice(object.require("format", "a vertex format")?, &formats)?;
        components += format.components();
        if components > COMPONENTS_MAX {
            return Err(value.refuse(format!(
                "found {components} components up to here, expected at most {COMPONENTS_MAX}"
            )));
        }
        layout.push(Attribute { name, format });
        Ok(())
    })?;
    if layout.is_empty() { Err(list.expected("at least one attribute")) } else { Ok(layout) }
}

fn values(rows: Value<'_>, layout: &[Attribute]) -> Found<Vec<f32>> {
    let formats: Vec<AttributeFormat> =
        layout.iter().flat_map(|a| std::iter::repeat_n(a.format, a.format.components())).collect();
    let what = format!("the {} numbers of a corner, in the order of the layout", formats.len());
    let mut values = Vec::new();
    rows.elements("an array of corners", |_, row| {
        let mut count = 0;
        row.elements(&what, |i, element| {
            let format = formats.get(i).ok_or_else(|| row.expected(&what))?;
            values.push(component(element, *format)?);
            count = i + 1;
            Ok(())
        })?;
        if count < formats.len() { Err(row.expected(&what)) } else { Ok(()) }
    })?;
    if values.is_empty() { Err(rows.expected("at least one corner")) } else { Ok(values) }
}

fn component(value: Value<'_>, format: AttributeFormat) -> Found<f32> {
    let number = real32(value)?;
    let (least, most) = format.range();
    if number < least || number > most {
        return Err(value
            .expected(format_args!("a number from {least} to {most}, as {} has", format.name())));
    }
    Ok(format.nearest(number))
}
