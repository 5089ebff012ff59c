//! The `tessim` command: hands its arguments to [`cli`] and its outcome to the shell.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
