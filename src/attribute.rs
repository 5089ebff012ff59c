//! Attributes: values at the corners of patches, that are interpolated over them. A leaf.
//!
//! Formats bear wgpu's names for vertices; those that can be interpolated, which integers cannot. A
//! value is one that its format has: `unorm8` numbers are rounded to the nearest of their 256 when
//! they are read, so what is computed with is what crosses the link.

/// The most components of a corner.
pub const COMPONENTS_MAX: usize = 64;

/// The attributes of some corners.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeTable {
    /// What a corner has, in order: at least one attribute, at most [`COMPONENTS_MAX`] components.
    pub layout: Vec<Attribute>,
    /// Components, corner after corner, each finite and a value of its format.
    pub values: Vec<f32>,
}

/// One attribute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// Its name: letters, digits and underscores, not starting with a digit.
    pub name: String,
    /// The numbers it has and how they cross the link.
    pub format: AttributeFormat,
}

impl AttributeTable {
    /// Numbers of a corner.
    #[must_use]
    pub fn components(&self) -> usize {
        self.layout.iter().map(|a| a.format.components()).sum()
    }

    /// Corners.
    #[must_use]
    pub fn corners(&self) -> u64 {
        (self.values.len() / self.components()) as u64
    }

    /// Bytes of a corner on the link.
    #[must_use]
    pub fn corner_bytes(&self) -> u64 {
        self.layout.iter().map(|a| a.format.bytes()).sum()
    }

    /// The values of a corner.
    ///
    /// # Panics
    /// When there is no such corner; a reader has checked that no draw asks for one.
    #[must_use]
    pub fn corner(&self, corner: u64) -> &[f32] {
        let components = self.components();
        let first = usize::try_from(corner).expect("corners are in memory") * components;
        &self.values[first..first + components]
    }
}

/// How a component is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Unorm8,
    Snorm8,
    Unorm16,
    Snorm16,
    Float16,
    Float32,
}

impl Kind {
    const fn bytes(self) -> u64 {
        match self {
            Self::Unorm8 | Self::Snorm8 => 1,
            Self::Unorm16 | Self::Snorm16 | Self::Float16 => 2,
            Self::Float32 => 4,
        }
    }

    /// The least and the greatest value, and steps to 1 where values are equally spaced.
    const fn range(self) -> (f32, f32, Option<f32>) {
        match self {
            Self::Unorm8 => (0.0, 1.0, Some(255.0)),
            Self::Snorm8 => (-1.0, 1.0, Some(127.0)),
            Self::Unorm16 => (0.0, 1.0, Some(65535.0)),
            Self::Snorm16 => (-1.0, 1.0, Some(32767.0)),
            Self::Float16 => (-65504.0, 65504.0, None),
            Self::Float32 => (f32::MIN, f32::MAX, None),
        }
    }

    /// The nearest value of this kind.
    fn nearest(self, value: f32) -> f32 {
        match self.range() {
            (.., Some(steps)) => (value * steps).round_ties_even() / steps,
            _ if self == Self::Float16 => half::f16::from_f32(value).to_f32(),
            _ => value,
        }
    }
}

/// The format of an attribute: a wgpu vertex format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AttributeFormat {
    kind: Kind,
    components: u8,
    name: &'static str,
}

macro_rules! formats {
    ($($name:literal $kind:ident $components:literal,)*) => {
        &[$(AttributeFormat { kind: Kind::$kind, components: $components, name: $name },)*]
    };
}

impl AttributeFormat {
    /// All of them.
    pub const ALL: &[Self] = formats! {
        "unorm8" Unorm8 1, "unorm8x2" Unorm8 2, "unorm8x4" Unorm8 4,
        "snorm8" Snorm8 1, "snorm8x2" Snorm8 2, "snorm8x4" Snorm8 4,
        "unorm16" Unorm16 1, "unorm16x2" Unorm16 2, "unorm16x4" Unorm16 4,
        "snorm16" Snorm16 1, "snorm16x2" Snorm16 2, "snorm16x4" Snorm16 4,
        "float16" Float16 1, "float16x2" Float16 2, "float16x4" Float16 4,
        "float32" Float32 1, "float32x2" Float32 2, "float32x3" Float32 3, "float32x4" Float32 4,
    };

    /// The format of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.name == name)
    }

    /// The name in traces, which is wgpu's.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// Its numbers.
    #[must_use]
    pub const fn components(self) -> usize {
        self.components as usize
    }

    /// Its bytes on the link.
    #[must_use]
    pub const fn bytes(self) -> u64 {
        self.kind.bytes() * self.components as u64
    }

    /// The least and the greatest value of a component.
    #[must_use]
    pub const fn range(self) -> (f32, f32) {
        let (least, most, _) = self.kind.range();
        (least, most)
    }

    /// Whether it has this very value for a component.
    #[must_use]
    pub fn has(self, value: f32) -> bool {
        let (least, most) = self.range();
        (least..=most).contains(&value) && self.nearest(value) == value
    }

    /// The nearest value that it has for a component.
    #[must_use]
    pub fn nearest(self, value: f32) -> f32 {
        self.kind.nearest(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_sizes_are_wgpus() {
        for format in AttributeFormat::ALL {
            assert_eq!(AttributeFormat::named(format.name()), Some(*format));
            // The name says it all: letters, bits of a component, components.
            let digits = format.name().trim_start_matches(|c: char| c.is_ascii_alphabetic());
            let (bits, count) = digits.split_once('x').unwrap_or((digits, "1"));
            let bytes = bits.parse::<u64>().unwrap() / 8 * count.parse::<u64>().unwrap();
            assert_eq!((format.bytes(), format.components()), (bytes, count.parse().unwrap()));
        }
        assert_eq!(AttributeFormat::named("uint8x4"), None);
    }

    #[test]
    fn a_value_is_one_that_its_format_has() {
        let nearest = |name: &str, value| AttributeFormat::named(name).unwrap().nearest(value);
        assert_eq!(nearest("unorm8x4", 0.5), 128.0 / 255.0);
        assert_eq!(nearest("snorm16", -1.0), -1.0);
        assert_eq!(nearest("float16x2", 0.1), 0.099_975_586);
        assert_eq!(nearest("float32", 0.1), 0.1);
        for format in AttributeFormat::ALL {
            for k in 0..=1000 {
                let once = format.nearest(k as f32 / 1000.0);
                assert_eq!(format.nearest(once), once, "{} {k}", format.name());
            }
        }
    }
}
