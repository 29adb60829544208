//! `tumble`: calibrates accelerometers against gravity. Glue only; one file a command.

mod cli;
mod commands;
mod exit;
#[cfg(test)]
mod help_tests;
mod interrupt;
mod progress;
mod quantity;

fn main() -> std::process::ExitCode {
    let arguments = cli::parse();
    interrupt::install();
    let code = match arguments.command {
        cli::Command::Init(a) => commands::init::run(&a),
        cli::Command::Check(a) => commands::check::run(&a),
        cli::Command::Certify(a) => commands::certify::run(&a),
        cli::Command::Simulate(a) => commands::simulate::run(&a),
        cli::Command::Noise(a) => commands::noise::run(&a),
        cli::Command::Plan(a) => commands::plan::run(&a),
        cli::Command::Compensate(a) => commands::compensate::run(&a),
        cli::Command::Explain(a) => commands::explain::run(&a),
        cli::Command::Completions(a) => commands::completions::run(&a),
        cli::Command::Man(a) => commands::man::run(&a),
        cli::Command::Catalogue(a) => commands::catalogue::run(&a),
    };
    // What was being written is whole; it was asked to stop all the same.
    if interrupt::interrupted() { exit::Exit::Interrupted.into() } else { code.into() }
}
