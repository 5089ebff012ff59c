//! `pattern`: tessellation factors in, the pattern of the domain out, one line of JSON each; for
//! unit esc the inserted candidates of a coarse triangle's edges in, its triangles out.
//!
//! One pattern from flags, or many from a file, a line each, as they come. An input line means the
//! same as the flags in their order: domain, partitioning, topology, factors; or esc, level, left,
//! right, bottom.

mod batch;
mod esc;
mod lines;
mod request;
mod shape;

use super::print;
use request::{Domain, Partitioning, Request, SHAPE_WORDS, Topology};
use std::io::Write;
use std::path::PathBuf;
use tessim::error::{Error, Result};

/// Print the tessellation pattern of given factors as JSON
///
/// Units hybrid and moreton take quads with partitioning fractional: the levels of the edges v0 u1
/// v1 u0 in segments per whole edge, then optionally those of the interior along u and v. Factors
/// are read as f32 (nan, inf and -inf too), rounded to UQ8.16 (to nearest, ties to even) and
/// clamped to 1..=128; nan counts as 1.
///
/// Unit d3d11 takes all domains, with partitioning integer, pow2, odd or even: for quads the
/// factors Ueq0 Veq0 Ueq1 Veq1 InU InV, for tris Ueq0 Veq0 Weq0 In, for isolines density and
/// detail. An edge's factor that is nan or not above 0 culls: points and indices are empty then.
///
/// Points are in U1.16. Indices are flat: 3 a triangle, 2 a line (hybrid: each distinct edge once,
/// in the order of first use, our choice; d3d11: the points one after another, in isolines line by
/// line), 1 a point.
///
/// Unit esc meshes a coarse triangle of level 1 to 15, which has level + 1 segments an edge: left
/// and right run from the apex down, bottom from left to right. Bits say which of an edge's
/// positions 1 to level are inserted; a row's inner vertices are where one of its ends is. Vertex
/// i of row r has the number r(r+1)/2+i+1; triangles are counter-clockwise with the apex at the
/// top.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  tessim pattern --topology ccw --factors 3.3,2.7,5.1,4.2,3,2\n  \
                        tessim pattern --unit d3d11 --domain tri --factors 3,2.5,4,3\n  \
                        echo 'quad fractional ccw 3.3 2.7 5.1 4.2' | tessim pattern --batch -\n  \
                        echo 'isoline even line 4 6' | tessim pattern --unit d3d11 --batch -\n  \
                        tessim pattern --unit esc --level 3 --left 101 --right 000\n  \
                        echo 'esc 3 101 000 111' | tessim pattern --unit esc --batch -"
)]
pub(crate) struct Args {
    /// The unit whose pattern it is
    #[arg(long, value_name = "U", value_enum, default_value = "hybrid")]
    unit: Unit,
    /// The domain [default: quad]
    #[arg(long, value_name = "D", value_enum, conflicts_with = "batch")]
    domain: Option<Domain>,
    /// The partitioning [default: fractional; of d3d11: odd]
    #[arg(long, value_name = "P", value_enum, conflicts_with = "batch")]
    partitioning: Option<Partitioning>,
    /// What the indices make [default: ccw; of isolines: line]
    #[arg(long, value_name = "T", value_enum, conflicts_with = "batch")]
    topology: Option<Topology>,
    /// The levels v0,u1,v1,u0[,InU,InV], or the factors in their order
    #[arg(long, value_name = "A,B,...", allow_hyphen_values = true)]
    #[arg(conflicts_with = "batch")]
    factors: Option<String>,
    #[command(flatten)]
    coarse: esc::CoarseArgs,
    /// A file of lines such as `quad fractional ccw 3.3 2.7 5.1 4.2 3 2`, or for unit esc
    /// `esc 3 101 000 111`; - for standard input
    #[arg(long, value_name = "FILE")]
    batch: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Unit {
    Hybrid,
    Moreton,
    #[value(name = "d3d11")]
    D3d11,
    Esc,
}

impl Unit {
    /// The unit whose patterns are made from factors; none for esc.
    fn of_factors(self) -> Option<request::Unit> {
        match self {
            Self::Hybrid => Some(request::Unit::Hybrid),
            Self::Moreton => Some(request::Unit::Moreton),
            Self::D3d11 => Some(request::Unit::D3d11),
            Self::Esc => None,
        }
    }
}

impl Args {
    /// Refuses flags that say nothing to the unit.
    fn check(&self) -> Result<()> {
        let Self { domain, partitioning, topology, factors, .. } = self;
        let factors = [
            ("--domain", domain.is_some()),
            ("--partitioning", partitioning.is_some()),
            ("--topology", topology.is_some()),
            ("--factors", factors.is_some()),
        ];
        let (flags, expected) = match self.unit {
            Unit::Esc => (&factors[..], "--level, --left, --right and --bottom, or --batch"),
            _ => (&self.coarse.given()[..], "--factors or --batch"),
        };
        match flags.iter().find(|(_, given)| *given) {
            Some((flag, _)) => {
                Err(Error::Usage(format!("found {flag}, expected what the unit takes: {expected}")))
            }
            None => Ok(()),
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<()> {
    args.check()?;
    let mut out = std::io::BufWriter::new(print::stdout());
    match (args.unit.of_factors(), &args.batch, &args.factors) {
        (None, Some(path), _) => esc::batch(path, &mut out)?,
        (None, None, _) => esc::one(&args.coarse, &mut out)?,
        (Some(unit), Some(path), _) => batch::run(unit, path, &mut out)?,
        (Some(unit), None, Some(factors)) => {
            let domain = args.domain.unwrap_or(Domain::Quad);
            let partitioning = args.partitioning.unwrap_or(unit.partitioning());
            let topology = args.topology.unwrap_or(domain.topology());
            let shape = (domain, partitioning, topology);
            let request = Request::new(unit, shape, factors.split(','));
            let request = request.map_err(|fault| {
                Error::Usage(match fault.word {
                    0..SHAPE_WORDS => fault.message,
                    _ => format!("--factors {factors}: {}", fault.message),
                })
            })?;
            shape::Writer::default().write(&request, &mut out).map_err(print::error)?;
        }
        (Some(_), None, None) => {
            return Err(Error::Usage("found nothing, expected --factors or --batch".to_owned()));
        }
    }
    out.flush().map_err(print::error)
}
