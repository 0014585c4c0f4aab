//! The benchmark cases and the other machines as tasks on model files.

use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use kinetostat::Pose;

use crate::{BenchQuantity, Places, Task, sample};

/// A machine and its range of commands.
#[derive(Clone, Copy, Debug)]
pub struct BenchMachine {
    /// Name of its file, see [`path`].
    pub file: &'static str,
    /// Description of the machine.
    pub what: &'static str,
    /// Spring coordinates.
    pub springs: usize,
    /// N and N m of the wrenches.
    load: (f64, f64),
    places: fn(Range<usize>) -> Places,
    /// True if commands lead to its pose.
    pub serial: bool,
}

/// Machine of W1 and W3.
pub const ARM: BenchMachine = BenchMachine {
    file: "arm",
    what: "arm of six joints",
    springs: 42,
    load: (2000.0, 300.0),
    places: |items| Places::Joints(sample::joints(items, 6, 1.0)),
    serial: true,
};

/// Machine of W2.
pub const HEXAPOD: BenchMachine = BenchMachine {
    file: "hexapod",
    what: "Stewart-Gough platform",
    springs: 42,
    load: (2000.0, 300.0),
    places: |items| Places::Poses(sample::poses(items, [0.0, 0.0, 0.9], 0.1, 0.15)),
    serial: false,
};

/// Machine of W4.
pub const PUU3: BenchMachine = BenchMachine {
    file: "puu3",
    what: "3-PUU",
    springs: 39,
    load: (300.0, 10.0),
    places: |items| Places::Poses(sample::poses(items, [0.0; 3], 0.09, 0.0)),
    serial: false,
};

/// All machines: those of the benchmark cases, then shapes that no case has.
pub const ALL: [BenchMachine; 6] = [
    ARM,
    HEXAPOD,
    PUU3,
    BenchMachine {
        file: "seven",
        what: "arm of seven joints",
        springs: 49,
        load: (100.0, 10.0),
        places: |items| Places::Joints(sample::joints(items, 7, 1.0)),
        serial: true,
    },
    BenchMachine {
        file: "puu4",
        what: "4-PUU, over-constrained",
        springs: 52,
        load: (300.0, 10.0),
        places: |items| Places::Poses(sample::poses(items, [0.0; 3], 0.06, 0.0)),
        serial: false,
    },
    BenchMachine {
        file: "hybrid",
        what: "hexapod with a wrist, 9 drives",
        springs: 63,
        load: (300.0, 10.0),
        places: |items| Places::Poses(sample::poses(items, [0.0, 0.0, 1.4], 0.05, 0.1)),
        serial: false,
    },
];

/// Names of the benchmark cases.
pub const CASES: [&str; 6] = ["W1", "W2", "W3", "W3+K", "W4", "W5"];

/// A benchmark case by its name, on so many postures that are the same in every run.
///
/// # Errors
/// If there is no such case, or its model cannot be read.
pub fn benchmark_case(name: &str, count: usize) -> Result<Task> {
    match name {
        "W1" => ARM.task(BenchQuantity::StiffnessAndJacobian, count, LinkLaw::Plain),
        "W2" => HEXAPOD.task(BenchQuantity::Stiffness, count, LinkLaw::Plain),
        "W3" => ARM.task(BenchQuantity::Equilibrium, count, LinkLaw::Plain),
        "W3+K" => ARM.task(
            BenchQuantity::EquilibriumAndStiffness,
            count,
            LinkLaw::Plain,
        ),
        "W4" => PUU3.task(BenchQuantity::Equilibrium, count, LinkLaw::Plain),
        "W5" => {
            let home = Places::Poses(vec![Pose::translation(1.0, 0.0, 0.0); count]);
            let across = [0.0, 10.0, 0.0, 0.0, 0.0, 0.0].repeat(count);
            Task::open(&path("rod"), BenchQuantity::Equilibrium, home, &across)
        }
        other => bail!("no benchmark case is called {other}"),
    }
}

/// Deformation law of a model's links.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkLaw {
    /// `translations_first`, the convention of the numpy baseline.
    Plain,
    /// `bowing`, the default of model files.
    Bowing,
}

/// A model file of the benchmarks.
#[must_use]
pub fn path(file: &str) -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.join(format!("../../benches/models/{file}.toml"))
}

impl BenchMachine {
    /// Returns `count` postures of this machine, or of its twin whose links have the default law.
    ///
    /// # Errors
    /// If its model cannot be read.
    pub fn task(&self, quantity: BenchQuantity, count: usize, links: LinkLaw) -> Result<Task> {
        let end = match links {
            LinkLaw::Plain => "",
            LinkLaw::Bowing => "_bowing",
        };
        let loaded = matches!(
            quantity,
            BenchQuantity::Equilibrium | BenchQuantity::EquilibriumAndStiffness
        );
        let wrenches = match loaded {
            true => sample::wrenches(0..count, self.load.0, self.load.1),
            false => Vec::new(),
        };
        let places = (self.places)(0..count);
        Task::open(
            &path(&format!("{}{end}", self.file)),
            quantity,
            places,
            &wrenches,
        )
    }

    /// The quantities of an unloaded machine: with its Jacobian where it has one.
    #[must_use]
    pub fn unloaded(&self) -> BenchQuantity {
        match self.serial {
            true => BenchQuantity::StiffnessAndJacobian,
            false => BenchQuantity::Stiffness,
        }
    }
}
