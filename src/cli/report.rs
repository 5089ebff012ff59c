//! `report`: a result folder as one page.

use super::counters;
use super::print;
use std::path::{Path, PathBuf};
use tessim::error::{Error, Result};
use tessim::output::file;
use tessim::output::page::{self, Folder};

/// Make one HTML page of a result folder
///
/// The page holds all it shows: tables to sort and to filter, plots and pictures, numbers over the
/// frames, what each number means, the configuration and the hashes of what was read. It takes the
/// folders that run, compare, precision and sweep write; docs/report.md says more. Of a table it
/// shows the first 2000 rows, of numbers over frames 2 MiB, and says what is left out.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim report result\n  \
                        tessim report studies/buses --out buses.html")]
pub(crate) struct Args {
    /// The folder, as --out of the other command named it
    folder: PathBuf,
    /// The page, outside the folder; - for standard output. A file that is there is replaced
    /// [default: the folder's path with .html behind it]
    #[arg(long, value_name = "PAGE.html")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    let folder = Folder::read(&args.folder)?;
    let out = args.out.clone().unwrap_or_else(|| beside(&args.folder, &folder.name));
    outside(&args.folder, &out)?;
    let html = page::html(&folder, &counters::definitions())?;
    print::bytes_to_file_or_stdout(&out, |to| to.write_all(html.as_bytes()))?;
    if quiet || out == Path::new("-") {
        return Ok(());
    }
    print::print(&format!("{}\n", out.display()))
}

/// Refuses a page within its own folder: it might replace what it was made of, and a command that
/// writes its result there again replaces nothing but results.
fn outside(folder: &Path, out: &Path) -> Result<()> {
    let whole = |path: &Path| path.canonicalize().map_err(|error| Error::system(path, error));
    // A link leads elsewhere. Where there is no such folder, writing the page says so.
    let place = out.canonicalize().or_else(|_| file::parent(out).canonicalize());
    let Ok(place) = place else { return Ok(()) };
    if out != Path::new("-") && place.starts_with(whole(folder)?) {
        let (out, folder) = (out.display(), folder.display());
        return Err(Error::Usage(format!(
            "--out {out}: lies in {folder}, of which it is the page; expected a place outside it"
        )));
    }
    Ok(())
}

/// The folder's name with `.html` behind it, beside the folder.
fn beside(folder: &Path, name: &str) -> PathBuf {
    match folder.file_name() {
        Some(name) => folder.with_file_name(format!("{}.html", name.display())),
        // `.` and `..` have no name to put another in place of.
        None => folder.join("..").join(format!("{name}.html")),
    }
}
