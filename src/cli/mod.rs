//! The command line: arguments in, text and exit codes out. No logic of the simulation.
//!
//! Exit codes: 0 done, 1 a check failed, 2 bad input or usage, 3 the system failed. Errors go to
//! standard error whatever `-q` says, and begin with the place where that is known. What a command
//! prints goes to standard output; a reader that leaves early ends the command quietly.

#[cfg(feature = "gpu")]
mod check;
mod compare;
mod config;
mod convert;
mod counters;
mod import;
mod info;
mod pattern;
mod precision;
mod print;
mod progress;
#[cfg(feature = "gpu")]
mod render;
mod report;
mod run;
mod scene;
mod study;
mod sweep;
mod table;

use clap::{Parser, Subcommand};
use std::process::ExitCode;
use tessim::error::Result;

/// Measures GPU tessellation units before they exist: traces of surfaces in, triangles and counters
/// out.
#[derive(Debug, Parser)]
#[command(name = "tessim", version, max_term_width = 100, disable_help_subcommand = true)]
#[command(after_help = "Exit codes: 0 done, 1 a check failed, 2 bad input or usage, 3 the system \
                        failed.\n\nExamples:\n  tessim run traces/teapot.jsonl\n  \
                        tessim run traces/teapot.jsonl --out result --mesh ply")]
struct Cli {
    /// Print no table and no progress; errors are printed all the same
    #[arg(short, long, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Args),
    Compare(compare::Args),
    #[cfg(feature = "gpu")]
    Check(check::Args),
    Info(info::Args),
    Config(config::Args),
    Counters(counters::Args),
    Scene(scene::Args),
    Convert(convert::Args),
    Import(import::Args),
    Pattern(pattern::Args),
    Study(study::Args),
    Precision(precision::Args),
    Sweep(sweep::Args),
    Report(report::Args),
    #[cfg(feature = "gpu")]
    Render(render::Args),
}

/// Runs the command that the process was started with.
pub(crate) fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version come this way too. Whether they could be printed changes nothing.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match cli.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if print::is_closed(&error) => ExitCode::SUCCESS,
        Err(error) => {
            anstream::eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

impl Cli {
    fn run(&self) -> Result<()> {
        match &self.command {
            Command::Run(args) => run::run(args, self.quiet),
            Command::Compare(args) => compare::run(args, self.quiet),
            #[cfg(feature = "gpu")]
            Command::Check(args) => check::run(args, self.quiet),
            Command::Info(args) => info::run(args),
            Command::Config(args) => config::run(args),
            Command::Counters(args) => counters::run(args),
            Command::Scene(args) => scene::run(args),
            Command::Convert(args) => convert::run(args),
            Command::Import(args) => import::run(args),
            Command::Pattern(args) => pattern::run(args),
            Command::Study(args) => study::run(args, self.quiet),
            Command::Precision(args) => precision::run(args, self.quiet),
            Command::Sweep(args) => sweep::run(args, self.quiet),
            Command::Report(args) => report::run(args, self.quiet),
            #[cfg(feature = "gpu")]
            Command::Render(args) => render::run(args),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definitions_are_consistent_and_every_command_has_two_examples() {
        Cli::command().debug_assert();
        let cli = Cli::command();
        let study = cli.find_subcommand("study").unwrap();
        for command in cli.get_subcommands().chain(study.get_subcommands()) {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let examples = help.lines().filter(|line| line.contains("tessim ")).count();
            assert!(examples >= 2, "{}: {help}", command.get_name());
        }
    }
}
