//! A task for many postures of one machine.

use std::hint::black_box;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use kinetostat::batch::{Batch, BatchEquilibrium, BatchStiffness, Details, Status, Table};
use kinetostat::{Mechanism, Pose, Wrench};
use kinetostat_model::Model;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3, Vector6};

/// The quantities requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchQuantity {
    /// Unloaded stiffness of the tool.
    Stiffness,
    /// Unloaded stiffness and Jacobian of a serial machine.
    StiffnessAndJacobian,
    /// Equilibrium under the wrenches.
    Equilibrium,
    /// Equilibrium and the tangent stiffness there.
    EquilibriumAndStiffness,
}

/// Commands of the machine.
#[derive(Clone, Debug)]
pub enum Places {
    /// Commands of all actuators (m or rad) of one posture after the other: a serial machine.
    Joints(Vec<f64>),
    /// Poses of the tool.
    Poses(Vec<Pose>),
}

impl Places {
    /// Reads 12 numbers per posture: rotation matrix (base from tool) row by row, position (m).
    ///
    /// # Errors
    /// If the numbers are no whole poses.
    pub fn from_numbers(numbers: &[f64]) -> Result<Self> {
        ensure!(
            numbers.len().is_multiple_of(12),
            "a pose is 12 numbers, {} are no whole poses",
            numbers.len()
        );
        let pose = |row: &[f64]| {
            let matrix = Matrix3::from_row_slice(&row[..9]);
            let turn =
                UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
            Pose::from_parts(Vector3::from_column_slice(&row[9..]).into(), turn)
        };
        Ok(Self::Poses(numbers.chunks(12).map(pose).collect()))
    }
}

/// A machine, where it is commanded, how it is loaded and what is computed.
#[derive(Debug)]
pub struct Task {
    // The machine lives as long as the program: a benchmark loads a handful.
    batch: Batch,
    places: Places,
    wrenches: Vec<Wrench>,
    quantity: BenchQuantity,
    actuators: usize,
}

/// Numbers of all postures, row by row.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    /// 12 numbers per posture as in [`Places::from_numbers`]; empty for an unloaded machine.
    pub tool: Vec<f64>,
    /// Coordinates of all limbs; empty for an unloaded machine.
    pub coordinates: Vec<f64>,
    /// 36 numbers per posture, row by row; empty where not requested.
    pub stiffness: Vec<f64>,
    /// 6 n numbers per posture, row by row; empty where not requested.
    pub jacobian: Vec<f64>,
    /// Number of postures that the vectorised kernels solved.
    pub vectorised: usize,
    /// Number of postures without a result.
    pub not_found: usize,
}

/// Results that are written over block by block.
#[derive(Debug, Default)]
pub struct Results {
    unloaded: BatchStiffness,
    loaded: BatchEquilibrium,
}

impl Task {
    /// A task on a model file. Wrenches (N, N m, base axes, about the tool's origin), one per
    /// posture, are for loaded cases only.
    ///
    /// # Errors
    /// If the file is no model or the numbers do not fit the machine.
    pub fn open(
        path: &Path,
        quantity: BenchQuantity,
        places: Places,
        wrenches: &[f64],
    ) -> Result<Self> {
        let model = kinetostat_model::read_model(path)
            .with_context(|| format!("cannot read the model {}", path.display()))?;
        Self::of_model(&model, quantity, places, wrenches)
    }

    /// Task for a model that is read.
    ///
    /// # Errors
    /// If the numbers do not fit the machine.
    pub fn of_model(
        model: &Model,
        quantity: BenchQuantity,
        places: Places,
        wrenches: &[f64],
    ) -> Result<Self> {
        Self::new(model.mechanism.clone(), quantity, places, wrenches)
    }

    /// Task for a machine.
    ///
    /// # Errors
    /// If the numbers do not fit the machine.
    pub fn new(
        machine: Mechanism,
        quantity: BenchQuantity,
        places: Places,
        wrenches: &[f64],
    ) -> Result<Self> {
        let numbers = wrenches.len();
        let wrenches: Vec<Wrench> = wrenches
            .chunks_exact(6)
            .map(|row| Wrench(Vector6::from_column_slice(row)))
            .collect();
        let task = Self {
            batch: Batch::new(&machine),
            places,
            wrenches,
            quantity,
            actuators: machine.actuator_names().len(),
        };
        let needed = if task.loaded() { 6 * task.len() } else { 0 };
        ensure!(
            numbers == needed,
            "'{}': wrenches of {needed} numbers are needed, there are {numbers}",
            machine.name(),
        );
        if let Places::Joints(commands) = &task.places {
            ensure!(
                commands.len() == task.actuators * task.len(),
                "'{}': {} commands are no whole postures of {} joints",
                machine.name(),
                commands.len(),
                task.actuators
            );
        }
        // Says whatever else does not fit.
        task.solve(0, task.len().min(1), &mut Results::default())?;
        Ok(task)
    }

    /// Number of postures.
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.places {
            Places::Poses(poses) => poses.len(),
            Places::Joints(commands) => commands.len() / self.actuators.max(1),
        }
    }

    /// True without postures.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Reason for which the postures of this machine are solved one by one, if they are.
    #[must_use]
    pub fn scalar_reason(&self) -> Option<String> {
        self.batch.engine().reason().map(ToString::to_string)
    }

    fn loaded(&self) -> bool {
        matches!(
            self.quantity,
            BenchQuantity::Equilibrium | BenchQuantity::EquilibriumAndStiffness
        )
    }

    fn solve(&self, from: usize, to: usize, out: &mut Results) -> Result<()> {
        let jacobian = self.quantity == BenchQuantity::StiffnessAndJacobian;
        let details = match self.quantity {
            BenchQuantity::EquilibriumAndStiffness => Details::Stiffness,
            _ => Details::Rest,
        };
        let (batch, unloaded, loaded) = (&self.batch, &mut out.unloaded, &mut out.loaded);
        match &self.places {
            Places::Joints(commands) => {
                let own = &commands[from * self.actuators..to * self.actuators];
                if self.loaded() {
                    let wrenches = &self.wrenches[from..to];
                    batch.equilibrium_at_joints_into(own, wrenches, details, loaded)?;
                } else {
                    match jacobian {
                        true => batch.stiffness_and_jacobian_into(own, unloaded)?,
                        false => batch.stiffness_at_joints_into(own, unloaded)?,
                    }
                }
            }
            Places::Poses(poses) => {
                let own = &poses[from..to];
                if self.loaded() {
                    batch.equilibrium_into(own, &self.wrenches[from..to], details, loaded)?;
                } else {
                    batch.stiffness_into(own, unloaded);
                }
            }
        }
        Ok(())
    }

    /// Goes once through all postures, `block` in each call, and writes the answers of a block over
    /// those of the last: what is timed.
    ///
    /// # Errors
    /// What the machine refuses.
    pub fn run(&self, block: usize, results: &mut Results) -> Result<()> {
        let block = block.max(1);
        for from in (0..self.len()).step_by(block) {
            self.solve(from, (from + block).min(self.len()), results)?;
            black_box(&*results);
        }
        Ok(())
    }

    /// Numbers of postures that are solved one by one, and not at all.
    ///
    /// # Errors
    /// What the machine refuses.
    pub fn not_vectorised(&self, block: usize) -> Result<(usize, usize)> {
        let block = block.max(1);
        let mut results = Results::default();
        let (mut scalar, mut not) = (0, 0);
        for from in (0..self.len()).step_by(block) {
            self.solve(from, (from + block).min(self.len()), &mut results)?;
            for found in self.found(&results) {
                scalar += usize::from(*found == Status::Scalar);
                not += usize::from(*found == Status::Unsolved);
            }
        }
        Ok((scalar, not))
    }

    fn found<'a>(&self, results: &'a Results) -> &'a [Status] {
        match self.loaded() {
            true => &results.loaded.status,
            false => &results.unloaded.status,
        }
    }

    /// The answers of all postures, `block` in each call.
    ///
    /// # Errors
    /// What the machine refuses.
    pub fn answers(&self, block: usize) -> Result<Answers> {
        let mut all = Answers::default();
        let add = |to: &mut Vec<f64>, table: &Table| {
            (0..table.len()).for_each(|i| to.extend(table.row(i)));
        };
        let block = block.max(1);
        let mut results = Results::default();
        for from in (0..self.len()).step_by(block) {
            self.solve(from, (from + block).min(self.len()), &mut results)?;
            let Results { unloaded, loaded } = &results;
            add(&mut all.tool, &loaded.tool);
            add(&mut all.coordinates, &loaded.coordinates);
            add(&mut all.jacobian, &unloaded.jacobian);
            match self.loaded() {
                true => add(&mut all.stiffness, &loaded.stiffness),
                false => add(&mut all.stiffness, &unloaded.stiffness),
            }
            let found = self.found(&results);
            let count = |how| found.iter().filter(|f| **f == how).count();
            all.vectorised += count(Status::Vectorised);
            all.not_found += count(Status::Unsolved);
        }
        Ok(all)
    }
}
