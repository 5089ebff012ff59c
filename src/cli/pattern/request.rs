//! What is asked for: words in, a checked request out, or a fault that says which word.

use rtl_model::patch::Level;
use serde::{Serialize, Serializer};

/// Domains of any unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(super) enum Domain {
    Quad,
    Tri,
    Isoline,
}

/// Partitionings of any unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(super) enum Partitioning {
    Integer,
    Pow2,
    Odd,
    Even,
    Fractional,
}

/// What indices make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(super) enum Topology {
    /// The points themselves
    Point,
    /// Each distinct edge once
    Line,
    /// Clockwise triangles
    Cw,
    /// Counter-clockwise triangles, u right and v up
    Ccw,
}

/// A factor as it was given. JSON has no numbers for those that are not finite: they become
/// strings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factor(pub(super) f32);

impl Serialize for Factor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            x if x.is_nan() => serializer.serialize_str("nan"),
            f32::INFINITY => serializer.serialize_str("inf"),
            f32::NEG_INFINITY => serializer.serialize_str("-inf"),
            x => serializer.serialize_f32(x),
        }
    }
}

impl Factor {
    /// Rounded to UQ8.16, to nearest with ties to even, and clamped to 1..=128. NaN is 1.
    pub(super) fn level(self) -> Level {
        // Exact in f64; the cast clamps at 0, and makes 0 of NaN.
        let fx16 = (f64::from(self.0) * f64::from(1 << 16)).round_ties_even();
        Level::clamped(fx16 as u64)
    }
}

/// A pattern that unit `hybrid` can make.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) domain: Domain,
    pub(super) partitioning: Partitioning,
    pub(super) topology: Topology,
    pub(super) factors: Vec<Factor>,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// Which factor, from 0: the one that is wrong, or the place of the one that is missing.
    /// `None`: the words before the factors.
    pub(super) factor: Option<usize>,
    pub(super) message: String,
}

impl Request {
    pub(super) fn new<'a>(
        domain: Domain,
        partitioning: Partitioning,
        topology: Topology,
        factors: impl Iterator<Item = &'a str>,
    ) -> Result<Self, Fault> {
        if (domain, partitioning) != (Domain::Quad, Partitioning::Fractional) {
            return Err(Fault { factor: None, message: not_hybrid(domain, partitioning) });
        }
        let factors = factors.enumerate().map(factor).collect::<Result<Vec<_>, _>>()?;
        match factors.len() {
            4 | 6 => Ok(Self { domain, partitioning, topology, factors }),
            n => Err(Fault {
                factor: Some(n.min(6)),
                message: format!("found {n} factors, expected 4 or 6: v0 u1 v1 u0 [InU InV]"),
            }),
        }
    }

    /// Levels of the edges v0 u1 v1 u0.
    pub(super) fn edges(&self) -> [Level; 4] {
        [0, 1, 2, 3].map(|i| self.factors[i].level())
    }

    /// Levels of the interior along u and v, where they were given.
    pub(super) fn interior(&self) -> [Option<Level>; 2] {
        [4, 5].map(|i| self.factors.get(i).map(|factor| factor.level()))
    }
}

fn not_hybrid(domain: Domain, partitioning: Partitioning) -> String {
    let name = |value: serde_json::Value| value.as_str().map(str::to_owned).unwrap_or_default();
    let domain = name(serde_json::json!(domain));
    let partitioning = name(serde_json::json!(partitioning));
    format!(
        "found domain {domain} with partitioning {partitioning}, expected what unit hybrid takes: \
         domain quad with partitioning fractional"
    )
}

fn factor((number, word): (usize, &str)) -> Result<Factor, Fault> {
    word.trim().parse().map(Factor).map_err(|_| {
        let word: String = word.chars().take(200).collect();
        let message = format!("found {word:?}, expected a number, nan, inf or -inf");
        Fault { factor: Some(number), message }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hybrid(factors: &str) -> Result<Request, Fault> {
        let (domain, partitioning) = (Domain::Quad, Partitioning::Fractional);
        Request::new(domain, partitioning, Topology::Ccw, factors.split(' '))
    }

    #[test]
    fn factors_become_levels_by_rounding_and_clamping() {
        let level = |x: f32| Factor(x).level().fx16();
        assert_eq!(level(1.5), 0x1_8000);
        assert_eq!(level(3.3), (f64::from(3.3f32) * 65536.0).round() as u32);
        // 1 + 2^-17 and 1 + 3 * 2^-17 are ties: to 65536 and to 65538.
        assert_eq!(level(1.0 + 0.5f32.powi(17)), 65536);
        assert_eq!(level(1.0 + 3.0 * 0.5f32.powi(17)), 65538);
        for low in [f32::NAN, f32::NEG_INFINITY, -3.0, -0.0, 0.0, 0.99, f32::MIN_POSITIVE] {
            assert_eq!(level(low), 1 << 16, "{low}");
        }
        for high in [128.0, 128.5, f32::MAX, f32::INFINITY] {
            assert_eq!(level(high), 128 << 16, "{high}");
        }
    }

    #[test]
    fn four_or_six_factors_are_taken() {
        assert_eq!(hybrid("1 2 3 4").unwrap().interior(), [None, None]);
        let six = hybrid("nan inf -inf -2 1e60 +3").unwrap();
        assert_eq!(six.interior(), [Some(Level::MAX), Some(Level::clamped(3 << 16))]);
        let json = serde_json::to_string(&six.factors).unwrap();
        assert_eq!(json, r#"["nan","inf","-inf",-2.0,"inf",3.0]"#);
        for wrong in ["1", "1 2 3 4 5", "1 2 3 4 5 6 7", "", "1 2 x 4"] {
            assert!(hybrid(wrong).is_err(), "{wrong}");
        }
        assert_eq!(hybrid("1 2 x 4").unwrap_err().factor, Some(2));
    }
}
