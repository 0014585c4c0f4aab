//! Which combinations of geometry readings of places decide, and what keeps the others at their nominal values.
//!
//! A shift along an axis of a joint before it and the opposite one behind it cancel: such directions move no place of a rigid arm. In an
//! elastic arm they move centres of mass, and with them places by micrometres, so that a rank decided there finds more directions than
//! can be known, and the estimate drifts. So the rank is decided on the rigid Jacobian, of the machine without weights and loads, and
//! what it takes to zero keeps its nominal value [theory: identification, section 3].

use kinetostat::Mechanism;
use kinetostat::linalg::SingularValues;
use kinetostat::number::larger;
use nalgebra::{DMatrix, DVector, RowDVector, Vector3};

use crate::error::IdentificationError;
use crate::experiment::{Observation, Reading, TestLoad};
use crate::geometry::is_geometry;
use crate::least_squares::LinearFit;
use crate::prediction::Machine;
use crate::unknown::{Form, Unknown, Unknowns};

/// Singular value relative to the largest, errors in mm and mrad, below which no place of a rigid machine shows a direction. Differences of
/// two machines leave 1e-10 of one that it does not show at all.
const RIGIDLY_UNSEEN: f64 = 1e-7;
/// Column relative to the longest below which a number does not move the rigid machine: it is one of loads.
const NO_GEOMETRY: f64 = 1e-9;

/// Directions of geometry that readings of places decide.
#[derive(Clone, Debug)]
pub struct Gauge {
    /// Number of geometric unknowns: errors, places of markers, and lengths and angles that were asked for.
    pub numbers: usize,
    /// Number of their combinations that are free; the others keep their nominal values.
    pub directions: usize,
    /// Changes of all unknowns without what no place of the rigid machine shows.
    free: DMatrix<f64>,
}

impl Gauge {
    /// Decides which combinations are free; none where no place was read, or nothing of the geometry is asked for.
    ///
    /// # Errors
    /// A posture in which the machine has no equilibrium.
    pub fn of(
        unknowns: &Unknowns,
        observations: &[Observation],
    ) -> Result<Option<Self>, IdentificationError> {
        let (sizes, list) = (unknowns.sizes(), unknowns.list());
        let is_any = |u: &Unknown| is_geometry(&u.parameter.path) || u.form == Form::Value;
        let mut readings = observations.iter().flat_map(|o| &o.readings);
        if !list.iter().any(is_any) || !readings.any(Reading::is_place) {
            return Ok(None);
        }
        let mut rigid = rigid_jacobian(unknowns, observations)?;
        for (mut column, size) in rigid.column_iter_mut().zip(sizes.iter()) {
            column *= *size;
        }
        let lengths: Vec<f64> = rigid.column_iter().map(|c| c.norm()).collect();
        let least = NO_GEOMETRY * lengths.iter().copied().fold(0.0, larger);
        let own: Vec<usize> = (0..list.len())
            .filter(|i| match list[*i].form {
                Form::Value => lengths[*i] > least,
                _ => is_geometry(&list[*i].parameter.path),
            })
            .collect();
        if own.is_empty() {
            return Ok(None);
        }
        let found = SingularValues::of(&rigid.select_columns(&own));
        let directions = found.rank(RIGIDLY_UNSEEN);
        let seen = found.right.columns(0, directions);
        let inner = seen * seen.transpose();
        let mut free = DMatrix::identity(list.len(), list.len());
        for (i, row) in own.iter().enumerate() {
            for (j, column) in own.iter().enumerate() {
                free[(*row, *column)] = inner[(i, j)] * sizes[*row] / sizes[*column];
            }
        }
        Ok(Some(Self {
            numbers: own.len(),
            directions,
            free,
        }))
    }

    /// Changes of the unknowns without what no place of the rigid machine shows.
    #[must_use]
    pub fn free_part(&self, change: &DVector<f64>) -> DVector<f64> {
        &self.free * change
    }

    /// Derivatives by the free directions alone.
    pub(crate) fn restrict(&self, derivatives: &mut DMatrix<f64>) {
        *derivatives = &*derivatives * &self.free;
    }

    /// Keeps the other directions at `nominal`, in the estimate and in its covariance.
    pub(crate) fn hold(&self, fit: &mut LinearFit, nominal: &DVector<f64>) {
        fit.estimate = nominal + self.free_part(&(&fit.estimate - nominal));
        for inverse in [&mut fit.normal_inverse, &mut fit.held_inverse] {
            *inverse = &self.free * &*inverse * self.free.transpose();
        }
    }
}

/// Derivatives by the unknowns of all places that were read, as the machine without weights and loads would show them.
fn rigid_jacobian(
    unknowns: &Unknowns,
    observations: &[Observation],
) -> Result<DMatrix<f64>, IdentificationError> {
    let values = unknowns.nominal();
    let changes = unknowns.changes(&values)?;
    let machine = Machine {
        mechanism: unknowns.mechanism(&values)?.without_own_loads(),
        changes: changes
            .iter()
            .map(|c| c.of_machine(Mechanism::without_own_loads))
            .collect(),
        markers: &unknowns.markers,
        places: unknowns.marker_places(&values),
    };
    let each = machine.each(observations, |machine, observation| {
        let mut places = observation.clone();
        places.load = TestLoad::force_at(observation.load.at, Vector3::zeros());
        places.readings.retain(Reading::is_place);
        let rows = machine.loaded(&places)?.derivatives;
        Ok(rows.row_iter().map(|row| row.into_owned()).collect())
    });
    let rows = each.into_iter();
    let rows: Vec<Vec<RowDVector<f64>>> = rows.collect::<Result<_, IdentificationError>>()?;
    Ok(DMatrix::from_rows(&rows.concat()))
}
