//! The pictures that there are of a frame.

use crate::error::{Error, Result};

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// The surface in light.
    Shaded,
    /// The edges of the triangles over it.
    Wireframe,
    /// Heat map: how many segments a patch has along an edge.
    Level,
    /// Heat map: how far triangles are from the true surface, in pixels.
    Error,
    /// Heat map: how large triangles are, in square pixels.
    Area,
}

/// All of them, in the order of a sheet.
pub const STYLES: [Style; 5] =
    [Style::Shaded, Style::Wireframe, Style::Level, Style::Error, Style::Area];

/// One style, or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taste {
    /// One picture.
    One(Style),
    /// A sheet of them.
    All,
}

impl Style {
    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Wireframe => "wireframe",
            Self::Level => "level",
            Self::Error => "error",
            Self::Area => "area",
        }
    }

    /// What the values of a heat map are, with their unit; `None` for other pictures.
    #[must_use]
    pub const fn quantity(self) -> Option<&'static str> {
        match self {
            Self::Shaded | Self::Wireframe => None,
            Self::Level => Some("segments along an edge, \u{221a}(triangles of the patch / 2)"),
            Self::Error => Some("distance from the true surface at the same parameters, pixels"),
            Self::Area => Some("area of a triangle, square pixels"),
        }
    }
}

impl Taste {
    /// The word for all styles.
    pub const ALL: &'static str = "all";

    /// The styles that are wanted.
    #[must_use]
    pub fn styles(self) -> Vec<Style> {
        match self {
            Self::One(style) => vec![style],
            Self::All => STYLES.to_vec(),
        }
    }

    /// The taste of this name.
    ///
    /// # Errors
    /// [`Error::Usage`] for another name, with those that there are.
    pub fn named(name: &str) -> Result<Self> {
        let style = STYLES.into_iter().find(|style| style.name() == name);
        match style {
            Some(style) => Ok(Self::One(style)),
            None if name == Self::ALL => Ok(Self::All),
            None => {
                let name: String = name.chars().take(200).collect();
                let names = STYLES.map(Style::name).join(", ");
                Err(Error::Usage(format!("style `{name}`: expected {names} or {}", Self::ALL)))
            }
        }
    }
}
