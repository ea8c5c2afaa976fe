//! The process `cosfly`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(cosfly::main(std::env::args_os().skip(1)))
}
