//! Runs the built command in a directory of its own.
#![allow(dead_code)]

pub mod chains;
pub mod checks;
mod schemas;
pub mod served;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub const BINARY: &str = env!("CARGO_BIN_EXE_kinetostat");

/// A small program that every preset with a workspace around its zero can run.
pub const PROGRAM: &str =
    "G21 G90 G17\nG0 X20 Y0 Z5\nG1 Z-1 F300\nG1 X0 Y20 F600\nG3 X-20 Y0 I0 J-20\nG0 Z5\nM2\n";

/// A job for it.
pub const JOB: &str = r#"schema = 1
model = "orthoglide"
program = "part.ngc"

[placement]
part_origin_mm = [0, 0, 100]

[tool]
length_mm = 100

[load]
milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }

[output]
program = "out.ngc"
"#;

/// A serial arm of one turning joint on a tube: the smallest model with everything that can be
/// wrong in one.
pub const MODEL: &str = r#"schema = 1

[mechanism]
name = "arm"
gravity_m_per_s2 = [0, 0, -9.81]

[[platform]]
name = "tool"
home = { position_mm = [800, 0, 0] }
mass_kg = 2

[section.tube]
tube = { outer_diameter_mm = 60, inner_diameter_mm = 50 }
youngs_modulus_gpa = 70
shear_modulus_gpa = 26

[chain.arm]
elements = [
  { actuator = "revolute", name = "shoulder", axis = "z", stiffness_n_m_per_rad = 2e5, limits_deg = [-90, 90] },
  { link = "tube", name = "boom", length_mm = 800 },
]

[[limb]]
name = "arm"
from = "base"
to = "tool"
chain = "arm"
"#;

/// What a command said.
#[derive(Debug)]
pub struct Said {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Said {
    pub fn of(output: Output) -> Self {
        Self {
            code: output.status.code().unwrap_or(-1),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// Fails the test unless the command answered; an answer may rest on assumptions (exit code 4).
    #[track_caller]
    pub fn answered(self) -> Self {
        assert!(matches!(self.code, 0 | 4), "{self:?}");
        self
    }
}

/// The command with a plain environment.
pub fn command(directory: &Path) -> Command {
    let mut command = Command::new(BINARY);
    command
        .current_dir(directory)
        .env_remove("CLICOLOR_FORCE")
        .env_remove("NO_COLOR")
        // The day of a run is stated: tests that compare bytes may run over midnight.
        .env("SOURCE_DATE_EPOCH", "1700000000")
        .stdin(Stdio::null());
    command
}

/// Runs the command; its JSON must follow the schema that the command publishes.
#[track_caller]
pub fn run(directory: &Path, arguments: &[&str]) -> Said {
    let output = command(directory).args(arguments).output();
    let said = Said::of(output.expect("the command starts"));
    schemas::check_results(directory, arguments, &said.out);
    said
}

/// Runs a line of `sh` in which `$K` is the command.
pub fn shell(directory: &Path, line: &str) -> Said {
    Said::of(
        Command::new("sh")
            .arg("-c")
            .arg(line)
            .env("K", BINARY)
            .env("SOURCE_DATE_EPOCH", "1700000000")
            .current_dir(directory)
            .stdin(Stdio::null())
            .output()
            .expect("sh starts"),
    )
}

/// A directory with the good program, job and model.
pub fn workplace() -> tempfile::TempDir {
    let directory = tempfile::tempdir().expect("a directory");
    let put = |name: &str, text: &str| {
        std::fs::write(directory.path().join(name), text).expect("a file");
    };
    put("part.ngc", PROGRAM);
    put("job.toml", JOB);
    put("model.toml", MODEL);
    directory
}

/// All files below a directory with their bytes; links as what they point to.
pub fn contents(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(directory).expect("a directory") {
        let path = entry.expect("an entry").path();
        let kind = std::fs::symlink_metadata(&path)
            .expect("metadata")
            .file_type();
        if kind.is_symlink() {
            let target = std::fs::read_link(&path).expect("a link");
            found.insert(path, target.display().to_string().into_bytes());
        } else if kind.is_dir() {
            found.insert(path.clone(), Vec::new());
            found.extend(contents(&path));
        } else if kind.is_file() {
            found.insert(path.clone(), std::fs::read(&path).expect("bytes"));
        }
    }
    found
}

/// The real programs that are kept outside the repository; `None` where they are absent.
pub fn gcode() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/gcode");
    if path.is_dir() {
        Some(path)
    } else {
        eprintln!("skipped: {} is not there", path.display());
        None
    }
}
