//! What is asked for: words in, a checked request out, or a fault that says which word.

use clap::ValueEnum;
use rtl_model::d3d11;
use rtl_model::patch::Level;
use serde::{Serialize, Serializer};

/// The units whose patterns are made from factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Hybrid,
    Moreton,
    D3d11,
}

impl Unit {
    /// The partitioning where none is given.
    pub(super) fn partitioning(self) -> Partitioning {
        match self {
            Self::Hybrid | Self::Moreton => Partitioning::Fractional,
            Self::D3d11 => Partitioning::Odd,
        }
    }
}

/// Domains of any unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(super) enum Domain {
    Quad,
    Tri,
    Isoline,
}

impl Domain {
    /// Unit `d3d11`'s.
    pub(super) fn d3d11(self) -> d3d11::Domain {
        match self {
            Self::Quad => d3d11::Domain::Quad,
            Self::Tri => d3d11::Domain::Tri,
            Self::Isoline => d3d11::Domain::Isoline,
        }
    }

    /// What the indices make where nothing is asked for.
    pub(super) fn topology(self) -> Topology {
        if self == Self::Isoline { Topology::Line } else { Topology::Ccw }
    }

    /// The factors of unit `d3d11`, in order.
    fn factors(self) -> &'static str {
        match self {
            Self::Quad => "Ueq0 Veq0 Ueq1 Veq1 InU InV",
            Self::Tri => "Ueq0 Veq0 Weq0 In",
            Self::Isoline => "density detail",
        }
    }
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

impl Partitioning {
    /// Unit `d3d11`'s, which has no other fractional ones.
    pub(super) fn d3d11(self) -> Option<d3d11::Partitioning> {
        match self {
            Self::Integer => Some(d3d11::Partitioning::Integer),
            Self::Pow2 => Some(d3d11::Partitioning::Pow2),
            Self::Odd => Some(d3d11::Partitioning::Odd),
            Self::Even => Some(d3d11::Partitioning::Even),
            Self::Fractional => None,
        }
    }
}

/// What indices make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(super) enum Topology {
    /// The points themselves
    Point,
    /// Each distinct edge once; for d3d11 the lines of isolines, elsewhere the points in order
    Line,
    /// Clockwise triangles
    Cw,
    /// Counter-clockwise triangles, u right and v up; for d3d11 as it has them, v down
    Ccw,
}

impl Topology {
    /// Unit `d3d11`'s.
    pub(super) fn d3d11(self) -> d3d11::Output {
        match self {
            Self::Point => d3d11::Output::Point,
            Self::Line => d3d11::Output::Line,
            Self::Cw => d3d11::Output::Cw,
            Self::Ccw => d3d11::Output::Ccw,
        }
    }
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

/// A pattern that the unit can make.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) unit: Unit,
    pub(super) domain: Domain,
    pub(super) partitioning: Partitioning,
    pub(super) topology: Topology,
    pub(super) factors: Vec<Factor>,
}

/// The words before the factors: domain, partitioning and topology.
pub(super) const SHAPE_WORDS: usize = 3;

/// Why there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// Which word of a line, from 0: the wrong one, or the place of the one that is missing.
    pub(super) word: usize,
    pub(super) message: String,
}

impl Request {
    pub(super) fn new<'a>(
        unit: Unit,
        (domain, partitioning, topology): (Domain, Partitioning, Topology),
        factors: impl Iterator<Item = &'a str>,
    ) -> Result<Self, Fault> {
        match unit {
            Unit::Hybrid | Unit::Moreton => fractional(domain, partitioning)?,
            Unit::D3d11 => fixed_function(domain, partitioning, topology)?,
        }
        let factors = factors.enumerate().map(factor).collect::<Result<Vec<_>, _>>()?;
        let (counts, names): (&[usize], _) = match (unit, domain) {
            (Unit::Hybrid | Unit::Moreton, _) => (&[4, 6], "v0 u1 v1 u0 [InU InV]"),
            (Unit::D3d11, Domain::Quad) => (&[6], domain.factors()),
            (Unit::D3d11, Domain::Tri) => (&[4], domain.factors()),
            (Unit::D3d11, Domain::Isoline) => (&[2], domain.factors()),
        };
        let found = factors.len();
        if counts.contains(&found) {
            return Ok(Self { unit, domain, partitioning, topology, factors });
        }
        let most = counts[counts.len() - 1];
        let expected = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
        Err(Fault {
            word: SHAPE_WORDS + found.min(most),
            message: format!("found {found} factors, expected {expected}: {names}"),
        })
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

/// What the units with Moreton's pattern take.
fn fractional(domain: Domain, partitioning: Partitioning) -> Result<(), Fault> {
    if (domain, partitioning) == (Domain::Quad, Partitioning::Fractional) {
        return Ok(());
    }
    let message = format!(
        "found domain {} with partitioning {}, expected what unit hybrid takes: domain quad with \
         partitioning fractional",
        name(&domain),
        name(&partitioning)
    );
    Err(Fault { word: 0, message })
}

/// What unit `d3d11` takes.
fn fixed_function(
    domain: Domain,
    partitioning: Partitioning,
    topology: Topology,
) -> Result<(), Fault> {
    if partitioning.d3d11().is_none() {
        let message = format!(
            "found partitioning {}, expected what unit d3d11 takes: integer, pow2, odd or even",
            name(&partitioning)
        );
        return Err(Fault { word: 1, message });
    }
    if domain == Domain::Isoline && matches!(topology, Topology::Cw | Topology::Ccw) {
        let message = format!(
            "found topology {}, expected what domain isoline has: point or line",
            name(&topology)
        );
        return Err(Fault { word: 2, message });
    }
    Ok(())
}

/// A value's name on the command line.
fn name(value: &impl ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

fn factor((number, word): (usize, &str)) -> Result<Factor, Fault> {
    word.trim().parse().map(Factor).map_err(|_| {
        let word: String = word.chars().take(200).collect();
        let message = format!("found {word:?}, expected a number, nan, inf or -inf");
        Fault { word: SHAPE_WORDS + number, message }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hybrid(factors: &str) -> Result<Request, Fault> {
        let (domain, partitioning) = (Domain::Quad, Partitioning::Fractional);
        let shape = (domain, partitioning, Topology::Ccw);
        Request::new(Unit::Hybrid, shape, factors.split(' '))
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
        assert_eq!(hybrid("1 2 x 4").unwrap_err().word, 5);
    }

    #[test]
    fn each_domain_takes_its_own_factors_and_topologies() {
        let d3d11 = |domain, partitioning, topology, factors: &str| {
            Request::new(Unit::D3d11, (domain, partitioning, topology), factors.split(' '))
        };
        let odd = |domain, topology, factors| d3d11(domain, Partitioning::Odd, topology, factors);
        let tris = [Topology::Point, Topology::Line, Topology::Cw, Topology::Ccw];
        for topology in tris {
            assert!(odd(Domain::Quad, topology, "1 2 3 4 5 nan").is_ok());
            assert!(odd(Domain::Tri, topology, "1 2 3 -inf").is_ok());
            let lines = odd(Domain::Isoline, topology, "1 2");
            assert_eq!(lines.is_ok(), matches!(topology, Topology::Point | Topology::Line));
        }
        let word = |fault: Result<Request, Fault>| fault.unwrap_err().word;
        assert_eq!(word(odd(Domain::Isoline, Topology::Cw, "1 2")), 2);
        assert_eq!(word(d3d11(Domain::Tri, Partitioning::Fractional, Topology::Cw, "1")), 1);
        assert_eq!(word(odd(Domain::Quad, Topology::Cw, "1 2 3 4")), 7);
        assert_eq!(word(odd(Domain::Tri, Topology::Cw, "1 2 3 4 5 6")), 7);
        assert_eq!(word(odd(Domain::Isoline, Topology::Line, "1 x")), 4);
    }
}
