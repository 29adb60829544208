//! `tumble`: calibrates accelerometers against gravity. Glue only; one file a command.

mod cli;
mod commands;
mod exit;
mod interrupt;
mod quantity;

use clap::Parser as _;

fn main() -> std::process::ExitCode {
    let arguments = cli::Cli::parse();
    interrupt::install();
    let code = match arguments.command {
        cli::Command::Certify(a) => commands::certify::run(&a),
        cli::Command::Simulate(a) => commands::simulate::run(&a),
        cli::Command::Compensate(a) => commands::compensate::run(&a),
        cli::Command::Catalogue(a) => commands::catalogue::run(&a),
    };
    code.into()
}
