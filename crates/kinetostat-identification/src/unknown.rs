//! The numbers of a model that are to be identified, as compliances.
//!
//! A deflection is linear in compliances, and stiffnesses that are fitted to measured deflections come out too small: errors of the
//! readings would stand among the regressors. So a stiffness `k` is identified as `c = 1/k`, a 6 x 6 stiffness as the 21 numbers of
//! its inverse, and the factor of a section as its reciprocal. Lengths and angles are identified as they are.

use kinetostat::Mechanism;
use kinetostat_model::{Model, Parameter, ParameterKind, ParametricModel};
use nalgebra::DVector;

use crate::body::BodyPoint;
use crate::compliance_matrix::{entries, entry_size, inverse, matrix_of, with_unit_diagonal};
use crate::cone::Constraint;
use crate::error::IdentificationError;
use crate::geometry::{DEVIATION, error_paths};
use crate::springs::{difference, drive_coordinates};

/// Components of a 6 x 6 matrix as paths name them.
const COMPONENTS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Compliance of a spring that is rigid, relative to what the model said. A millionth would leave the equilibria of heavy arms less exact
/// than the fit needs.
const RIGID: f64 = 1e-4;

/// How an unknown enters the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Form {
    /// The reciprocal of a stiffness, a modulus, a rigidity or a factor.
    Compliance,
    /// Row and column of a compliance matrix whose inverse stands in the model.
    MatrixEntry(usize, usize),
    /// The stiffness itself, of a spring that acts as a load beside the joints (a gravity compensator): deflections are nearly linear in
    /// it and not in its reciprocal.
    Parallel,
    /// The number itself.
    Value,
    /// Shift or turn of a deviation of the geometry.
    Geometry,
    /// Component of the place of a marker in the frame of its body: no number of the model.
    Marker(usize, usize),
    /// Angle or length by which friction holds a drive back, while its torque grows as while it shrinks: no number of the model.
    Friction,
}

impl Form {
    /// True for a number of the model file.
    pub(crate) fn is_of_model(self) -> bool {
        !matches!(self, Self::Marker(..) | Self::Friction)
    }
}

/// One number to identify.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// The number of the model that it decides.
    pub parameter: Parameter,
    /// How it enters the model.
    pub form: Form,
    /// What the model says, in SI: rad/(N m), m/N, m, rad.
    pub nominal: f64,
    /// A size that it can be compared with: its own, or that of its matrix.
    pub size: f64,
}

/// Unknowns of a model, in an order.
#[derive(Clone, Debug)]
pub struct Unknowns {
    pub(crate) parametric: ParametricModel,
    pub(crate) list: Vec<Unknown>,
    /// Markers whose places are unknown, at their nominal places.
    pub(crate) markers: Vec<BodyPoint>,
}

impl Unknowns {
    /// The numbers that match the patterns: a path, a path with `*` for any text, the path of a whole matrix, or `joints` for the
    /// stiffness of every drive, or `geometry` for the errors of the geometry of every limb. Patterns take the springs that they match; a length, an angle or a mass is named by its whole path.
    ///
    /// ```
    /// use kinetostat_identification::Unknowns;
    /// let model = kinetostat_model::Model::preset("kuka_kr270_like")?;
    /// let joints = Unknowns::matching(&model, &["joints"])?;
    /// assert_eq!(joints.list().len(), 6);
    /// assert!((joints.list()[1].nominal - 1.0 / 3.31e6).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A pattern that matches nothing, or numbers that no deflection shows.
    pub fn matching(model: &Model, patterns: &[&str]) -> Result<Self, IdentificationError> {
        let all = model.parameters();
        let drives = drives(model, &all);
        let errors = match patterns.contains(&"geometry") {
            true => error_paths(model, &all)?,
            false => Vec::new(),
        };
        let mut paths: Vec<&str> = Vec::new();
        for pattern in patterns {
            if *pattern == "geometry" {
                paths.extend(errors.iter().map(String::as_str));
                continue;
            }
            let hits = |p: &Parameter| match *pattern {
                "joints" => drives.contains(&p.path.as_str()),
                // Several at once are those of springs; a length or a mass is named by itself. A table by its path has no factor on it.
                own => {
                    let rest = p.path.strip_prefix(own);
                    let is_inside = rest.is_some_and(|rest| rest.starts_with('.'));
                    let is_any = is_inside || (own.contains('*') && matches(own, &p.path));
                    let is_spring =
                        matches!(form(p), Some(Form::Compliance | Form::MatrixEntry(..)));
                    own == p.path
                        || (is_any
                            && is_spring
                            && (own.contains('*') || p.kind != ParameterKind::Factor))
                }
            };
            let found: Vec<&str> = all
                .iter()
                .filter(|p| hits(p))
                .map(|p| p.path.as_str())
                .collect();
            // A deviation that the file does not have is zero.
            if found.is_empty() && pattern.starts_with(DEVIATION) {
                paths.push(pattern);
                continue;
            }
            if found.is_empty() {
                let springs = all.iter().filter(|p| form(p) == Some(Form::Compliance));
                return Err(IdentificationError::NoNumber {
                    pattern: (*pattern).to_owned(),
                    examples: springs.take(3).map(|p| p.path.clone()).collect(),
                });
            }
            paths.extend(found);
        }
        let whole = with_whole_matrices(&all, &paths);
        let paths: Vec<&str> = whole.iter().map(String::as_str).collect();
        let parametric = model.parametric(&paths)?;
        let list = unknowns(parametric.parameters())?;
        let mut found = Self {
            parametric,
            list,
            markers: Vec::new(),
        };
        found.tell_springs_beside_joints()?;
        Ok(found)
    }

    /// Stiffnesses that change no spring of a limb are those of loads.
    fn tell_springs_beside_joints(&mut self) -> Result<(), IdentificationError> {
        let own = self.in_file(&self.nominal());
        for (i, unknown) in self.list.iter_mut().enumerate() {
            if unknown.form != Form::Compliance {
                continue;
            }
            let at = |factor: f64| {
                let mut moved = own.clone();
                moved[i] *= factor;
                self.parametric.mechanism(&moved)
            };
            if difference(&at(1.25)?, &at(0.75)?, 1.0).is_empty() {
                unknown.form = Form::Parallel;
                unknown.nominal = own[i] * unknown.parameter.in_si;
                unknown.size = unknown.nominal;
            }
        }
        Ok(())
    }

    /// The same, and the friction of every drive.
    #[must_use]
    pub fn with_friction(mut self, model: &Model) -> Self {
        let names = model.mechanism.actuator_names();
        for (name, (kind, _)) in names.into_iter().zip(drive_coordinates(&model.mechanism)) {
            self.list.push(Unknown {
                parameter: Parameter {
                    path: format!("friction of {name}"),
                    value: 0.0,
                    unit: if kind == ParameterKind::Angle {
                        "rad"
                    } else {
                        "m"
                    },
                    kind,
                    in_si: 1.0,
                },
                form: Form::Friction,
                nominal: 0.0,
                size: 1e-4,
            });
        }
        self
    }

    /// The unknowns.
    #[must_use]
    pub fn list(&self) -> &[Unknown] {
        &self.list
    }

    /// What the model says of them, in SI.
    #[must_use]
    pub fn nominal(&self) -> DVector<f64> {
        DVector::from_iterator(self.list.len(), self.list.iter().map(|u| u.nominal))
    }

    /// Sizes that changes of them can be compared with.
    #[must_use]
    pub fn sizes(&self) -> DVector<f64> {
        DVector::from_iterator(self.list.len(), self.list.iter().map(|u| u.size))
    }

    /// What the unknowns must meet: compliances are not negative, matrices are positive semi-definite.
    pub(crate) fn constraints(&self) -> Vec<Constraint> {
        let own = |(i, unknown): (usize, &Unknown)| match unknown.form {
            Form::Compliance | Form::Parallel | Form::Friction => Some(Constraint::NonNegative(i)),
            Form::MatrixEntry(0, 0) => {
                Some(Constraint::PositiveSemidefinite((i..i + 21).collect()))
            }
            _ => None,
        };
        self.list.iter().enumerate().filter_map(own).collect()
    }

    /// The unknowns with the least compliance that a model can have: a rigid spring is ten thousand times as stiff as it was.
    pub(crate) fn buildable(&self, values: &DVector<f64>) -> DVector<f64> {
        let mut out = values.clone();
        for (i, Unknown { form, size, .. }) in self.list.iter().enumerate() {
            match form {
                Form::Compliance | Form::Parallel => out[i] = out[i].max(RIGID * size),
                Form::MatrixEntry(0, 0) => {
                    let upper = values.rows(i, 21).into_owned();
                    let yields = with_unit_diagonal(&matrix_of(&upper))
                        .symmetric_eigenvalues()
                        .min();
                    // A load without a deflection gets a little of one.
                    let own = entries()
                        .zip(i..i + 21)
                        .filter(|((r, c), _)| r == c && yields.is_nan() | (yields <= RIGID));
                    own.for_each(|(_, k)| out[k] += RIGID * self.list[k].size);
                }
                _ => {}
            }
        }
        out
    }

    /// Numbers of the model file, each in its own unit, for these unknowns.
    #[must_use]
    pub fn in_file(&self, values: &DVector<f64>) -> Vec<f64> {
        let mut out = Vec::with_capacity(values.len());
        for (i, unknown) in self.list.iter().enumerate() {
            let si = match unknown.form {
                Form::Compliance => 1.0 / values[i],
                Form::Value | Form::Geometry | Form::Parallel => values[i],
                Form::Marker(..) | Form::Friction => continue,
                Form::MatrixEntry(row, column) => {
                    if (row, column) == (0, 0) {
                        let stiffness = inverse(&matrix_of(&values.rows(i, 21).into_owned()));
                        out.extend(
                            entries()
                                .zip(&self.list[i..])
                                .map(|((r, c), u)| stiffness[(r, c)] / u.parameter.in_si),
                        );
                    }
                    continue;
                }
            };
            out.push(si / unknown.parameter.in_si);
        }
        out
    }

    /// The machine with these unknowns.
    ///
    /// # Errors
    /// As for a model file with these numbers.
    pub fn mechanism(&self, values: &DVector<f64>) -> Result<Mechanism, IdentificationError> {
        Ok(self.parametric.mechanism(&self.in_file(values))?)
    }
}

/// Paths of the stiffnesses of all drives among the numbers of a model.
fn drives<'p>(model: &Model, all: &'p [Parameter]) -> Vec<&'p str> {
    let limbs = model.mechanism.limbs().iter();
    let drives = limbs.flat_map(|limb| limb.nominal.actuators());
    let endings: Vec<String> = drives.map(|a| format!(".{}.stiffness_n", a.name)).collect();
    let paths = all.iter().map(|p| p.path.as_str());
    paths
        .filter(|path| path.starts_with("chain."))
        .filter(|path| endings.iter().any(|ending| path.contains(ending)))
        .collect()
}

/// True if `pattern`, with `*` for any text, is the whole of `path`.
fn matches(pattern: &str, path: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = path.strip_prefix(parts.next().unwrap_or("")) else {
        return false;
    };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else {
        return rest.is_empty();
    };
    for part in parts {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

/// Path of the matrix to which a number belongs, with its row and column.
fn in_matrix(path: &str) -> Option<(&str, usize, usize)> {
    let mut parts = path.rsplitn(3, '.');
    let at = |part: &str| COMPONENTS.iter().position(|c| *c == part);
    let (column, row) = (at(parts.next()?)?, at(parts.next()?)?);
    let matrix = parts.next()?;
    let key = matrix.rsplit('.').next()?;
    (key.starts_with("matrix_n_")).then_some((matrix, row, column))
}

/// The paths, each once; a matrix is identified as a whole, because its inverse has all entries.
fn with_whole_matrices(all: &[Parameter], paths: &[&str]) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for path in paths {
        if out.iter().any(|p| p == path) {
            continue;
        }
        match in_matrix(path) {
            Some((matrix, ..)) => {
                let same = |p: &&Parameter| in_matrix(&p.path).is_some_and(|m| m.0 == matrix);
                out.extend(all.iter().filter(same).map(|p| p.path.clone()));
            }
            None => out.push((*path).to_owned()),
        }
    }
    out
}

/// How a number of the file is identified; none where no deflection shows it.
fn form(parameter: &Parameter) -> Option<Form> {
    if let Some((_, row, column)) = in_matrix(&parameter.path) {
        return Some(Form::MatrixEntry(row, column));
    }
    match parameter.kind {
        ParameterKind::Stiffness
        | ParameterKind::RotationalStiffness
        | ParameterKind::Elasticity
        | ParameterKind::Rigidity
        | ParameterKind::Factor => Some(Form::Compliance),
        _ if parameter.path.starts_with(DEVIATION) => Some(Form::Geometry),
        ParameterKind::Length | ParameterKind::Angle | ParameterKind::Mass => Some(Form::Value),
        _ => None,
    }
}

fn unknowns(parameters: &[Parameter]) -> Result<Vec<Unknown>, IdentificationError> {
    let mut list: Vec<Unknown> = Vec::with_capacity(parameters.len());
    for parameter in parameters {
        let not = || IdentificationError::NotIdentified {
            path: parameter.path.clone(),
            kind: parameter.kind.word(),
        };
        let form = form(parameter).ok_or_else(not)?;
        let si = parameter.value * parameter.in_si;
        let (nominal, size) = match form {
            Form::Compliance if si > 0.0 => (1.0 / si, 1.0 / si),
            Form::Compliance => return Err(not()),
            Form::MatrixEntry(..) => (si, 1.0),
            _ => (si, value_size(parameter)),
        };
        list.push(Unknown {
            parameter: parameter.clone(),
            form,
            nominal,
            size,
        });
    }
    // From the stiffnesses of a matrix to its compliances.
    for first in 0..list.len() {
        if list[first].form != Form::MatrixEntry(0, 0) {
            continue;
        }
        let stiffness =
            DVector::from_iterator(21, list[first..first + 21].iter().map(|u| u.nominal));
        let compliance = inverse(&matrix_of(&stiffness));
        for ((row, column), unknown) in entries().zip(&mut list[first..first + 21]) {
            unknown.nominal = compliance[(row, column)];
            unknown.size = entry_size(row, column, |k| compliance[(k, k)]);
        }
    }
    Ok(list)
}

/// Size that an error of a length, an angle or a mass is compared with, SI.
fn value_size(parameter: &Parameter) -> f64 {
    match parameter.kind {
        ParameterKind::Mass => (parameter.value * parameter.in_si).abs().max(1.0),
        _ => 1e-3,
    }
}
