//! How a machine changes with the unknowns: the springs' matrices, or the whole machine.

use kinetostat::Mechanism;
use nalgebra::{DMatrix, DVector, Matrix6};
use rayon::prelude::*;

use crate::compliance_matrix::{entries, entry_size, index_of, inverse, matrix_of};
use crate::error::IdentificationError;
use crate::springs::{SpringChange, difference, scaled};
use crate::unknown::{Form, Unknown, Unknowns};

/// How a machine changes with one unknown.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    /// Springs only.
    Springs(Vec<SpringChange>),
    /// Anything: two machines, and the difference of the unknown between them.
    Machine {
        more: Mechanism,
        less: Mechanism,
        step: f64,
    },
    /// Not at all: the place of a marker on the tool, by its number and component.
    Marker(usize, usize),
    /// Not at all: a drive that friction holds back. They follow all numbers of the model, in the order of the drives.
    Friction,
}

impl Change {
    /// The same, of machines to which something was done.
    pub fn of_machine(&self, done: impl Fn(&Mechanism) -> Mechanism) -> Self {
        match self {
            Self::Machine { more, less, step } => Self::Machine {
                more: done(more),
                less: done(less),
                step: *step,
            },
            other => other.clone(),
        }
    }
}

/// Change of a stiffness matrix with an entry of its inverse: `dK = -K dC K`.
fn stiffness_change(upper: &DVector<f64>, row: usize, column: usize) -> Matrix6<f64> {
    let stiffness = inverse(&matrix_of(upper));
    let mut unit = Matrix6::zeros();
    unit[(row, column)] = 1.0;
    unit[(column, row)] = 1.0;
    -stiffness * unit * stiffness
}

/// Change of the springs with an entry of a compliance matrix, from their changes with the entries of its inverse: `dK = -K dC K`.
fn of_entry(
    upper: &DVector<f64>,
    row: usize,
    column: usize,
    by_stiffness: &[Change],
) -> Vec<SpringChange> {
    let change = stiffness_change(upper, row, column);
    let mut sum: Vec<SpringChange> = Vec::new();
    for ((r, c), by_stiffness) in entries().zip(by_stiffness) {
        let Change::Springs(springs) = by_stiffness else {
            continue;
        };
        for part in scaled(springs, change[(r, c)]) {
            let same = |s: &&mut SpringChange| s.limb == part.limb && s.first == part.first;
            match sum.iter_mut().find(same) {
                Some(own) => own.matrix += part.matrix,
                None => sum.push(part),
            }
        }
    }
    sum
}

impl Unknowns {
    /// How the machine changes with every unknown, at certain values of them.
    pub(crate) fn changes(
        &self,
        values: &DVector<f64>,
    ) -> Result<Vec<Change>, IdentificationError> {
        let own = self.in_file(values);
        let of_model = self.list.iter().filter(|u| u.form.is_of_model());
        let of_model: Vec<(usize, &Unknown)> = of_model.enumerate().collect();
        let by_number = of_model.into_par_iter().map(|(i, unknown)| {
            // The springs are linear in the number, so that a large step is exact.
            let step = match unknown.form {
                Form::Compliance => 0.25 * own[i],
                Form::MatrixEntry(row, column) => {
                    1e-3 * stiffness_size(&self.list, i, row, column) / unknown.parameter.in_si
                }
                Form::Parallel => 0.5 * own[i],
                _ => 1e-2 * unknown.size / unknown.parameter.in_si,
            };
            let at = |sign: f64| {
                let mut moved = own.clone();
                moved[i] += sign * step;
                self.parametric.mechanism(&moved)
            };
            let (more, less) = (at(1.0)?, at(-1.0)?);
            let double = 2.0 * step * unknown.parameter.in_si;
            let springs = match unknown.form {
                Form::Compliance | Form::MatrixEntry(..) => difference(&more, &less, double),
                _ => Vec::new(),
            };
            Ok::<_, IdentificationError>(match springs.is_empty() {
                true => Change::Machine {
                    more,
                    less,
                    step: double,
                },
                false => Change::Springs(springs),
            })
        });
        let mut out = self.by_compliance(values, by_number.collect::<Result<_, _>>()?);
        let behind = self.list.iter().skip(out.len());
        out.extend(behind.map(|unknown| match unknown.form {
            Form::Marker(marker, k) => Change::Marker(marker, k),
            _ => Change::Friction,
        }));
        Ok(out)
    }

    /// Derivatives of the numbers of the file, each in its unit, by the unknowns.
    pub(crate) fn slopes_in_file(&self, values: &DVector<f64>) -> DMatrix<f64> {
        let count = self.list.len();
        let mut slopes = DMatrix::zeros(count, count);
        for (i, unknown) in self.list.iter().enumerate() {
            let in_si = unknown.parameter.in_si;
            match unknown.form {
                Form::Compliance => slopes[(i, i)] = -values[i].powi(-2) / in_si,
                Form::MatrixEntry(row, column) => {
                    let first = i - index_of(row, column);
                    let change =
                        stiffness_change(&values.rows(first, 21).into_owned(), row, column);
                    for (k, entry) in entries().enumerate() {
                        slopes[(first + k, i)] =
                            change[entry] / self.list[first + k].parameter.in_si;
                    }
                }
                _ => slopes[(i, i)] = 1.0 / in_si,
            }
        }
        slopes
    }

    /// From derivatives by stiffnesses to those by compliances.
    fn by_compliance(&self, values: &DVector<f64>, by_number: Vec<Change>) -> Vec<Change> {
        let mut out = Vec::with_capacity(by_number.len());
        for (i, (unknown, change)) in self.list.iter().zip(&by_number).enumerate() {
            let factor = -values[i].powi(-2);
            out.push(match (unknown.form, change) {
                (Form::Compliance, Change::Springs(springs)) => {
                    Change::Springs(scaled(springs, factor))
                }
                (Form::Compliance, Change::Machine { more, less, step }) => Change::Machine {
                    more: more.clone(),
                    less: less.clone(),
                    step: step / factor,
                },
                (Form::MatrixEntry(row, column), _) => {
                    let first = i - index_of(row, column);
                    let upper = values.rows(first, 21).into_owned();
                    Change::Springs(of_entry(&upper, row, column, &by_number[first..first + 21]))
                }
                (_, own) => own.clone(),
            });
        }
        out
    }
}

/// Size of an entry of a stiffness matrix in the model, SI.
fn stiffness_size(list: &[Unknown], at: usize, row: usize, column: usize) -> f64 {
    let first = at - index_of(row, column);
    entry_size(row, column, |k| {
        let own = &list[first + index_of(k, k)].parameter;
        (own.value * own.in_si).abs()
    })
}
