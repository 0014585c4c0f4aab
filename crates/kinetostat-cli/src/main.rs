//! The kinetostat command: see the library beside it.

use std::process::ExitCode;

fn main() -> ExitCode {
    kinetostat_cli::main()
}
