//! `tumble`: calibrates accelerometers against gravity. Glue only; one file a command.

mod cli;
mod commands;
mod exit;
mod interrupt;
mod progress;
mod quantity;

use clap::Parser as _;

fn main() -> std::process::ExitCode {
    let arguments = cli::Cli::parse();
    interrupt::install();
    let code = match arguments.command {
        cli::Command::Init(a) => commands::init::run(&a),
        cli::Command::Check(a) => commands::check::run(&a),
        cli::Command::Certify(a) => commands::certify::run(&a),
        cli::Command::Simulate(a) => commands::simulate::run(&a),
        cli::Command::Compensate(a) => commands::compensate::run(&a),
    };
    // What was being written is whole; it was asked to stop all the same.
    if interrupt::interrupted() { exit::Exit::Interrupted.into() } else { code.into() }
}
