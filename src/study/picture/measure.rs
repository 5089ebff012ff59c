//! The values of heat maps, and which scales show them well.

use super::Style;
use crate::gpu::render::Scale;

/// Of a list of values, what a legend says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Values {
    /// How many there are.
    pub count: usize,
    /// The smallest; 0 of none.
    pub least: f64,
    /// Their mean; 0 of none.
    pub mean: f64,
    /// The largest; 0 of none.
    pub most: f64,
    /// What one in a hundred exceeds.
    pub usual: f64,
}

impl Values {
    /// Of these values.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(&least), Some(&most)) = (sorted.first(), sorted.last()) else {
            return Self::default();
        };
        let count = sorted.len();
        let mean = sorted.iter().sum::<f64>() / count as f64;
        let usual = sorted[(count - 1) - (count - 1) / 100];
        Self { count, least, mean, most, usual }
    }

    /// Of both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        if self.count == 0 || other.count == 0 {
            return if self.count == 0 { other } else { self };
        }
        let count = self.count + other.count;
        let sum = self.mean * self.count as f64 + other.mean * other.count as f64;
        Self {
            count,
            least: self.least.min(other.least),
            mean: sum / count as f64,
            most: self.most.max(other.most),
            usual: self.usual.max(other.usual),
        }
    }
}

/// Decades of areas that are told apart.
const DECADES: f64 = 4.0;

/// The scale that shows values well, its ends round numbers.
#[must_use]
pub fn scale(style: Style, values: &Values) -> Scale {
    let linear = |least: f64, most: f64| Scale { least, most, log: false };
    match style {
        Style::Shaded | Style::Wireframe => linear(0.0, 1.0),
        Style::Level => linear(values.least.floor(), values.most.ceil()),
        // A few triangles at a patch's collapsed corner would leave the rest no colours.
        Style::Error => linear(0.0, round_up(values.usual)),
        Style::Area => {
            let decade = |value: f64, round: fn(f64) -> f64| {
                10_f64.powf(round(value.max(f64::MIN_POSITIVE).log10()))
            };
            let most = decade(values.usual.max(1e-3), f64::ceil);
            let least = decade(values.least, f64::floor).max(most / 10_f64.powf(DECADES));
            Scale { least: least.min(most / 10.0), most, log: true }
        }
    }
}

/// The next of 1, 2 and 5 times a power of ten; 1 for nothing.
fn round_up(value: f64) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    let decade = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    steps.into_iter().find(|step| *step >= value * (1.0 - 1e-12)).unwrap_or(steps[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_summed_up_and_scales_have_round_ends() {
        let values = Values::of(&[3.5, 1.5, 2.0]);
        assert_eq!((values.least, values.most, values.usual), (1.5, 3.5, 3.5));
        assert!((values.mean - 7.0 / 3.0).abs() < 1e-12);
        assert_eq!(scale(Style::Level, &values), Scale { least: 1.0, most: 4.0, log: false });
        assert_eq!(scale(Style::Error, &values).most, 5.0);
        let both = values.with(Values::of(&[9.0])).with(Values::default());
        assert_eq!((both.count, both.mean, both.most), (4, 4.0, 9.0));
        let area = scale(Style::Area, &Values::of(&[0.02, 350.0]));
        assert!((area.least - 0.1).abs() < 1e-9 && (area.most - 1000.0).abs() < 1e-9);
        // One outlier in two hundred moves no scale.
        let mut many = vec![0.3; 200];
        many.push(1e3);
        assert_eq!(scale(Style::Error, &Values::of(&many)).most, 0.5);
        assert_eq!([0.1, 0.11, 0.5, 7.0, 0.0].map(round_up), [0.1, 0.2, 0.5, 10.0, 1.0]);
    }
}
