//! How facets are painted, and the colours of heat maps.

/// What a facet's colour says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The surface in the light of a lamp beside the camera.
    Shaded,
    /// The same, lighter, with the edges of all triangles.
    Wireframe,
    /// The value of the facets' corners on a scale, without light: a colour is a value.
    Map(Scale),
}

/// Which values the ends of the colours stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The value of the darkest colour; what is less has that too.
    pub least: f64,
    /// The value of the lightest; what is more has that too.
    pub most: f64,
    /// By the values' logarithms; both ends are above 0.
    pub log: bool,
}

impl Scale {
    /// Where on the scale a value is, from 0 to 1. On a scale without extent, in the middle.
    #[must_use]
    pub fn place(&self, value: f64) -> f64 {
        let of = |value: f64| if self.log { value.max(f64::MIN_POSITIVE).ln() } else { value };
        let (least, most) = (of(self.least), of(self.most));
        if most > least { ((of(value) - least) / (most - least)).clamp(0.0, 1.0) } else { 0.5 }
    }
}

/// The paint and what goes with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// What colours say.
    pub paint: Paint,
    /// Width of the edges' lines in pixels; 0 for none.
    pub line: f32,
    /// Where nothing is.
    pub background: [u8; 3],
}

impl Look {
    /// The look for a picture of `size` pixels: lines that print alike at any size.
    #[must_use]
    pub fn new(paint: Paint, size: [u32; 2]) -> Self {
        let side = size[0].max(size[1]) as f32;
        Self { paint, line: (side / 1100.0).max(0.75), background: [246, 247, 249] }
    }

    /// Without lines.
    #[must_use]
    pub fn without_lines(self) -> Self {
        Self { line: 0.0, ..self }
    }
}

/// The colour at a place from 0 to 1: viridis, whose steps look alike everywhere, in print without
/// colours and to the colour-blind too (Smith and van der Walt 2015).
#[must_use]
pub fn colour(place: f64) -> [u8; 3] {
    let colour = colorous::VIRIDIS.eval_continuous(place.clamp(0.0, 1.0));
    [colour.r, colour.g, colour.b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_scales_are_of_values_or_their_logarithms() {
        let linear = Scale { least: 2.0, most: 4.0, log: false };
        assert_eq!([1.0, 2.0, 3.0, 9.0].map(|v| linear.place(v)), [0.0, 0.0, 0.5, 1.0]);
        let log = Scale { least: 0.1, most: 1000.0, log: true };
        assert!((log.place(10.0) - 0.5).abs() < 1e-12);
        assert_eq!(log.place(0.0), 0.0);
        assert_eq!(Scale { least: 8.0, most: 8.0, log: false }.place(8.0), 0.5);
    }

    #[test]
    fn colours_grow_lighter_all_the_way() {
        let light = |step: u32| {
            let [r, g, b] = colour(f64::from(step) / 32.0).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((1..=32).all(|step| light(step) > light(step - 1)));
        assert_eq!((colour(-1.0), colour(2.0)), (colour(0.0), colour(1.0)));
    }
}
