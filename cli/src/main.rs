//! The program `qdist`: certified depths from files, one subcommand for each kind of question.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use qdist_cli::{CLOSED, depth, grasp, haptic, mesh};

/// Certified brackets: how deep is this grasp, body or mesh inside that set, and how sure are we?
///
/// Every answer is a bracket, lower <= d <= upper, true in floating point. `qdist COMMAND --help` teaches the command, with the least file that
/// it takes.
///
/// The exit code is 1 when a file or an answer is wrong, 2 for the command line.
#[derive(Parser)]
#[command(name = "qdist", version, args_override_self = true)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Grasp(grasp::Request),
    Mesh(mesh::Request),
    Depth(depth::Request),
    Haptic(haptic::Request),
}

fn main() -> ExitCode {
    let done = match Line::parse().command {
        Command::Grasp(request) => grasp::run(&request),
        Command::Mesh(request) => mesh::run(&request),
        Command::Depth(request) => depth::run(&request),
        Command::Haptic(request) => haptic::run(&request),
    };
    match done {
        Err(trouble) if trouble != CLOSED => {
            eprintln!("{trouble}");
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}
