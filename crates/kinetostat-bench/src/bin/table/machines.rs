//! The works and the other machines as tasks on model files.

use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::Result;
use kinetostat_bench::{Places, Task, Work, sample};

/// A machine and where it is asked.
pub struct Machine {
    pub file: &'static str,
    pub what: &'static str,
    /// Spring coordinates.
    pub springs: usize,
    /// N and N m of the wrenches.
    load: (f64, f64),
    places: fn(Range<usize>) -> Places,
    pub serial: bool,
}

pub const ARM: Machine = Machine {
    file: "arm",
    what: "arm of six joints",
    springs: 42,
    load: (2000.0, 300.0),
    places: |items| Places::Joints(sample::joints(items, 6, 1.0)),
    serial: true,
};

pub const HEXAPOD: Machine = Machine {
    file: "hexapod",
    what: "Stewart-Gough platform",
    springs: 42,
    load: (2000.0, 300.0),
    places: |items| Places::Poses(sample::poses(items, [0.0, 0.0, 0.9], 0.1, 0.15)),
    serial: false,
};

pub const PUU3: Machine = Machine {
    file: "puu3",
    what: "3-PUU",
    springs: 39,
    load: (300.0, 10.0),
    places: |items| Places::Poses(sample::poses(items, [0.0; 3], 0.09, 0.0)),
    serial: false,
};

/// All machines: those of the works, then shapes that no work has.
pub const ALL: [Machine; 6] = [
    ARM,
    HEXAPOD,
    PUU3,
    Machine {
        file: "seven",
        what: "arm of seven joints",
        springs: 49,
        load: (100.0, 10.0),
        places: |items| Places::Joints(sample::joints(items, 7, 1.0)),
        serial: true,
    },
    Machine {
        file: "puu4",
        what: "4-PUU, over-constrained",
        springs: 52,
        load: (300.0, 10.0),
        places: |items| Places::Poses(sample::poses(items, [0.0; 3], 0.06, 0.0)),
        serial: false,
    },
    Machine {
        file: "hybrid",
        what: "hexapod with a wrist, 9 drives",
        springs: 63,
        load: (300.0, 10.0),
        places: |items| Places::Poses(sample::poses(items, [0.0, 0.0, 1.4], 0.05, 0.1)),
        serial: false,
    },
];

/// A model file of the benchmarks.
pub fn path(file: &str) -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.join(format!("../../benches/models/{file}.toml"))
}

impl Machine {
    /// So many postures of this machine, or of its twin whose links have the default law.
    pub fn task(&self, work: Work, count: usize, bowing: bool) -> Result<Task> {
        let end = if bowing { "_bowing" } else { "" };
        let loaded = matches!(work, Work::Equilibrium | Work::EquilibriumAndStiffness);
        let wrenches = match loaded {
            true => sample::wrenches(0..count, self.load.0, self.load.1),
            false => Vec::new(),
        };
        let places = (self.places)(0..count);
        Task::open(
            &path(&format!("{}{end}", self.file)),
            work,
            places,
            &wrenches,
        )
    }

    /// What is asked of an unloaded machine: with its Jacobian where it has one.
    pub fn unloaded(&self) -> Work {
        match self.serial {
            true => Work::StiffnessAndJacobian,
            false => Work::Stiffness,
        }
    }
}
