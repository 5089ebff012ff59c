//! `run`: a trace through a unit; a table on the terminal, and a result folder where one is asked
//! for.

use super::config::Layered;
use super::print;
use super::progress::Progress;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::iter;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use tessim::config::{Config, Engine, Frames};
use tessim::error::{Error, Result};
use tessim::output::folder::ResultFolder;
use tessim::output::mesh::{MeshFile, MeshForm};
use tessim::output::summary::Provenance;
use tessim::output::timeline::{self, Labels, TimelineFile};
use tessim::output::{result, table};
use tessim::report::Report;
use tessim::report::timeline::{Timeline, Wanted, Window};
use tessim::sink::{NoMesh, Sink};
pub(super) use tessim::study::provenance::provenance;
use tessim::trace::command::{Command, Header};
use tessim::trace::open::Trace;
use tessim::unit::{simulate, simulate_watched};

/// Run a trace through a unit
///
/// Prints a table; with --out writes config.toml, counters.csv, summary.json, and what was asked
/// for: the mesh, and with an engine the occupancy of the FIFOs. With --timeline writes what each
/// block did and when.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim run traces/teapot.jsonl --set level.level=8\n  \
                        tessim run traces/teapot.jsonl --out result --mesh ply --frame 0\n  \
                        tessim run traces/teapot.jsonl --timeline teapot.json --timeline-window \
                        cycles:0..5000")]
pub(crate) struct Args {
    /// The trace; - for standard input
    trace: PathBuf,
    #[command(flatten)]
    layered: Layered,
    /// What lays time over the blocks; over all layers [default: timed]
    #[arg(long, value_name = "E", value_parser = engines())]
    engine: Option<Engine>,
    /// Threads, any number of which give the same bytes [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Also write the mesh of a frame (with --out)
    #[arg(long, value_name = "FORM", value_enum)]
    mesh: Option<Form>,
    /// Also write the timeline of a frame: FILE.json for Perfetto or chrome://tracing, FILE.vcd
    /// (FIFO levels and handshakes) for a waveform viewer; may be given for both
    #[arg(long, value_name = "FILE", value_parser = timeline_file)]
    timeline: Vec<PathBuf>,
    /// The part of the frame that it shows: cycles:A..B, or patches:A..B, the cycles from when the
    /// first of them is sent until all that came of the last has left [default: all]
    #[arg(long, value_name = "WINDOW", requires = "timeline")]
    timeline_window: Option<Window>,
    /// The frame whose mesh or timeline is written, from 0 [default: 0]
    #[arg(long, value_name = "N")]
    frame: Option<u64>,
    /// Run this frame alone, from 0: as a trace of its own, whose only frame is 0. What is live
    /// where the frame begins crosses the link before it and is counted in it
    #[arg(long, value_name = "N", conflicts_with = "frame")]
    only_frame: Option<u64>,
    /// Write the results into this folder; one that exists is replaced only if a run wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn engines() -> impl TypedValueParser<Value = Engine> {
    PossibleValuesParser::new(Engine::ALL.map(Engine::name))
        .map(|name| Engine::named(&name).expect("only names of engines are possible values"))
}

fn timeline_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let known = timeline::Form::of(&path).is_some();
    if known { Ok(path) } else { Err("expected a name that ends in .json or .vcd".to_owned()) }
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Form {
    /// Exact: world and fixed-point clip coordinates, parameters, patches
    Ply,
    /// World coordinates as text
    Obj,
    /// Wireframe of the projected frame
    Svg,
}

impl From<Form> for MeshForm {
    fn from(form: Form) -> Self {
        match form {
            Form::Ply => Self::Ply,
            Form::Obj => Self::Obj,
            Form::Svg => Self::Svg,
        }
    }
}

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    args.refuse_a_mesh_without_a_folder()?;
    let mut config = args.layered.configuration()?;
    config.engine = args.engine.unwrap_or(config.engine);
    args.refuse_a_frame_of_nothing(&config)?;
    args.refuse_a_timeline_over_others()?;
    let pool = pool(args.threads)?;
    let reader = match args.only_frame {
        None => Trace::open(&args.trace)?,
        Some(frame) => Trace::open_frame(&args.trace, frame)?,
    };
    let folder = args.out.as_deref().map(ResultFolder::create).transpose()?;
    let begin = |path: &PathBuf| {
        let form = timeline::Form::of(path).expect("the arguments were read with their forms");
        TimelineFile::create(path, form)
    };
    let timelines: Vec<_> = args.timeline.iter().map(begin).collect::<Result<_>>()?;
    let results = args.simulate(reader, &config, &pool, folder.as_ref(), quiet)?;
    let Results { report, timeline, provenance } = results;
    let labels = Labels { title: &provenance.title, config: &report.config };
    for file in timelines {
        file.finish(timeline.as_ref().expect("it was asked for"), &labels)?;
    }
    if let Some(folder) = folder {
        for (name, bytes) in result::files(&report, &provenance) {
            folder.write(name, &bytes)?;
        }
        folder.commit()?;
    }
    if quiet { Ok(()) } else { print::print(&table::text(&report, &provenance.title)) }
}

struct Results {
    report: Report,
    timeline: Option<Timeline>,
    provenance: Provenance,
}

impl Args {
    fn refuse_a_mesh_without_a_folder(&self) -> Result<()> {
        if self.mesh.is_some() && self.out.is_none() {
            return Err(Error::Usage(
                "--mesh writes into the result folder: give --out DIR too".to_owned(),
            ));
        }
        Ok(())
    }

    /// A timeline takes the place of what is there: not of the trace, nor of a result.
    fn refuse_a_timeline_over_others(&self) -> Result<()> {
        let canonical = |path: &Path| path.canonicalize().ok();
        for file in &self.timeline {
            let shown = file.display();
            let parent = file.parent().filter(|p| !p.as_os_str().is_empty());
            let parent = canonical(parent.unwrap_or(Path::new(".")));
            let out = self.out.as_deref();
            if out.is_some_and(|out| parent.is_some() && canonical(out) == parent) {
                return Err(Error::Usage(format!(
                    "--timeline {shown}: found in the result folder, expected a place beside it"
                )));
            }
            if canonical(file).is_some_and(|file| canonical(&self.trace) == Some(file)) {
                return Err(Error::Usage(format!(
                    "--timeline {shown}: found the trace, expected another file"
                )));
            }
        }
        Ok(())
    }

    fn refuse_a_frame_of_nothing(&self, config: &Config) -> Result<()> {
        if self.frame.is_none() || self.mesh.is_some() {
            return Ok(());
        }
        let message = if self.timeline.is_empty() {
            "--frame is that of a mesh or a timeline: give --mesh or --timeline too"
        } else if config.frames == Frames::Overlap
            && !matches!(self.timeline_window, Some(Window::Patches(_)))
        {
            "--frame: frames overlap, and their timeline is one: expected a --timeline-window"
        } else {
            return Ok(());
        };
        Err(Error::Usage(message.to_owned()))
    }

    /// The part of the run that a timeline is wanted of.
    fn wanted(&self) -> Option<Wanted> {
        let window = self.timeline_window.clone().unwrap_or_default();
        let wanted = Wanted { frame: self.frame.unwrap_or(0), window };
        (!self.timeline.is_empty()).then_some(wanted)
    }

    fn simulate(
        &self,
        mut reader: Trace,
        config: &Config,
        pool: &ThreadPool,
        folder: Option<&ResultFolder>,
        quiet: bool,
    ) -> Result<Results> {
        // The header is needed before the rest: a picture bears the trace's title.
        let first = reader.next().transpose()?;
        let header = match first.as_ref().map(|located| &located.command) {
            Some(Command::Header(header)) => header.clone(),
            _ => Header::default(),
        };
        let mut mesh = folder.zip(self.mesh).map(|(folder, form)| {
            let frame = self.frame.unwrap_or(0);
            MeshFile::create(form.into(), &folder.path(), frame, &header.title, config)
        });
        let mut mesh = mesh.take().transpose()?;
        let mut progress = Progress::new(quiet, "");
        let rest = reader.by_ref();
        let commands = iter::once(first).flatten().map(Ok).chain(rest).map(|located| {
            let command = located?.command;
            progress.command(&command);
            Ok(command)
        });
        let (report, timeline) = pool.install(|| {
            let mut none = NoMesh;
            let sink: &mut dyn Sink = match &mut mesh {
                Some(mesh) => mesh,
                None => &mut none,
            };
            match self.wanted() {
                None => simulate(commands, config, sink).map(|report| (report, None)),
                Some(wanted) => simulate_watched(commands, config, sink, &wanted)
                    .map(|(report, timeline)| (report, Some(timeline))),
            }
        })?;
        drop(progress);
        if let Some(mesh) = mesh {
            mesh.finish(report.frames.len())?;
        }
        Ok(Results { report, timeline, provenance: provenance(header, &reader)? })
    }
}

pub(super) fn pool(threads: Option<NonZeroUsize>) -> Result<ThreadPool> {
    // 0 stands for one thread a core.
    let threads = threads.map_or(0, NonZeroUsize::get);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| Error::system("threads", std::io::Error::other(error)))
}
