//! Controller coordinates: joint values as the controller shows them, a declared linear map of the model's.

use kinetostat::{Mechanism, MotionKind};
use nalgebra::{DMatrix, DVector};

use crate::elements::quantity::{DEG, MM, ReadResult, by_kind, choice, choices, forbid, need};
use crate::findings::{Findings, name};
use crate::problem::{Finding, KeyPath};
use crate::schema::{
    ControllerAxisTable, ControllerCoupling, ControllerTable, ControllerUnit, Document,
};
use crate::text::hints::unknown;

/// Axis that a controller displays, and its actuator.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerAxis {
    /// Name as the controller shows it.
    pub name: String,
    /// Index of its actuator in the order of [`kinetostat::Mechanism::actuator_names`].
    pub joint: usize,
    /// Unit that the controller shows.
    pub unit: ControllerUnit,
}

/// Map from joint values to controller coordinates: `shown = S model + offset`, in m and rad, `S` square and regular.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    axes: Vec<ControllerAxis>,
    map: DMatrix<f64>,
    inverse: DMatrix<f64>,
    offset: DVector<f64>,
}

impl Controller {
    /// The axes in the order of the controller.
    #[must_use]
    pub fn axes(&self) -> &[ControllerAxis] {
        &self.axes
    }

    /// Rows are axes of the controller, columns the model's joints in the order of
    /// [`kinetostat::Mechanism::actuator_names`]; m and rad.
    #[must_use]
    pub fn map(&self) -> &DMatrix<f64> {
        &self.map
    }

    /// Returns the controller coordinates of the model's joint values (m, rad, in the order of
    /// [`kinetostat::Mechanism::actuator_names`]), each in the unit of its axis. `None` if there are not as many values
    /// as actuators.
    #[must_use]
    pub fn coordinates(&self, joints: &[f64]) -> Option<Vec<f64>> {
        if joints.len() != self.axes.len() {
            return None;
        }
        let shown = &self.map * DVector::from_column_slice(joints) + &self.offset;
        let units = shown.iter().zip(&self.axes);
        Some(units.map(|(x, axis)| x / axis.unit.in_si()).collect())
    }

    /// The model's joint values, m and rad, for what the controller shows (one number per axis, in the
    /// axis' unit): the inverse of [`coordinates`](Self::coordinates). `None` if there are not as many values
    /// as axes.
    #[must_use]
    pub fn joints(&self, shown: &[f64]) -> Option<Vec<f64>> {
        if shown.len() != self.axes.len() {
            return None;
        }
        let units = shown.iter().zip(&self.axes);
        let shown: Vec<f64> = units.map(|(x, axis)| x * axis.unit.in_si()).collect();
        let joints = &self.inverse * (DVector::from_vec(shown) - &self.offset);
        Some(joints.iter().copied().collect())
    }

    /// Formula of an axis by the model's joints: `joint_3 - joint_2`, `-joint_1 + 90 deg`.
    #[must_use]
    pub fn description(&self, axis: usize, joints: &[String]) -> String {
        let own = self.axes[axis].joint;
        let others = (0..self.map.ncols()).filter(|&j| j != own);
        let unit = self.axes[axis].unit;
        let mut text = String::new();
        for j in std::iter::once(own).chain(others) {
            let ratio = self.map[(axis, j)];
            if ratio != 0.0 {
                join(&mut text, ratio, joints.get(j).map_or("?", String::as_str));
            }
        }
        let offset = self.offset[axis] / unit.in_si();
        if offset != 0.0 {
            let sign = if offset < 0.0 { "-" } else { "+" };
            // Degrees come back from radians with rounding in their last digits.
            let size = (offset.abs() * 1e9).round() / 1e9;
            text.push_str(&format!(" {sign} {size} {}", unit.word()));
        }
        text
    }
}

fn join(text: &mut String, ratio: f64, joint: &str) {
    let sign = match (text.is_empty(), ratio < 0.0) {
        (true, true) => "-",
        (true, false) => "",
        (false, true) => " - ",
        (false, false) => " + ",
    };
    text.push_str(sign);
    if ratio.abs() != 1.0 {
        text.push_str(&format!("{} ", ratio.abs()));
    }
    text.push_str(joint);
}

/// The map that the document declares; `None` if it declares none or if it has errors.
pub(crate) fn controller(
    document: &Document,
    mechanism: &Mechanism,
    findings: &mut Findings,
) -> Option<Controller> {
    let table = document.controller.as_ref()?;
    let place = KeyPath::root().key("controller");
    if let Some(text) = &table.name {
        name(&place.key("name"), text, findings);
    }
    let names = mechanism.actuator_names();
    let rows = rows(&place, table, mechanism, &names, findings)?;
    if let Some(missing) = (0..names.len()).find(|j| rows.axes.iter().all(|a| a.joint != *j)) {
        findings.error(
            &place,
            format!("no axis of the controller belongs to '{}'", names[missing]),
            format!(
                "write {{ name = \"{}{}\", joint = \"{}\" }} in 'axis': the controller has an axis for every actuator",
                "J",
                missing + 1,
                names[missing]
            ),
        );
        return None;
    }
    let Rows { axes, map, offset } = rows;
    match inverse(&map) {
        Ok(inverse) => Some(Controller {
            axes,
            map,
            inverse,
            offset,
        }),
        Err(unseen) => {
            let moving: Vec<&str> = (0..names.len())
                .filter(|&j| unseen[j].abs() > 1e-6)
                .map(|j| names[j].as_str())
                .collect();
            findings.error(
                &place.key("axis"),
                format!(
                    "the controller cannot tell the joints apart: {} can move together and it shows no change",
                    moving.join(" and ")
                ),
                "check the couplings; every motion of the joints must show on the controller",
            );
            None
        }
    }
}

/// The axes of the controller, row by row.
struct Rows {
    axes: Vec<ControllerAxis>,
    map: DMatrix<f64>,
    offset: DVector<f64>,
}

/// Reads every axis; `None` with errors in `findings`.
fn rows(
    place: &KeyPath,
    table: &ControllerTable,
    mechanism: &Mechanism,
    names: &[String],
    findings: &mut Findings,
) -> Option<Rows> {
    let before = findings.errors.len();
    let kinds: Vec<MotionKind> = mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
        .collect();
    let mut map = DMatrix::zeros(table.axis.len(), names.len());
    let mut offset = DVector::zeros(table.axis.len());
    let mut axes: Vec<ControllerAxis> = Vec::new();
    for (row, axis) in table.axis.iter().enumerate() {
        if findings.enough() {
            return None;
        }
        let place = place.key("axis").index(row);
        name(&place.key("name"), &axis.name, findings);
        if axes.iter().any(|a| a.name == axis.name) {
            findings.error(
                &place.key("name"),
                format!("the controller has an axis '{}' already", axis.name),
                "rename one of them",
            );
        }
        let Some(joint) = findings.keep(actuator(&place, &axis.joint, names)) else {
            continue;
        };
        if let Some(other) = axes.iter().find(|a| a.joint == joint) {
            findings.error(
                &place.key("joint"),
                format!(
                    "the axis '{}' belongs to '{}' already",
                    other.name, names[joint]
                ),
                "one axis for each actuator; a share in another axis is written as coupled = [{ joint = ..., ratio = ... }]",
            );
        }
        let mut shares = vec![0.0; names.len()];
        if let Some(unit) = findings.keep(own(&place, axis, kinds[joint])) {
            shares[joint] = unit.ratio;
            offset[row] = unit.offset;
            axes.push(ControllerAxis {
                name: axis.name.clone(),
                joint,
                unit: unit.unit,
            });
        }
        couplings(
            &place,
            &axis.coupled,
            joint,
            &kinds,
            names,
            &mut shares,
            findings,
        );
        map.row_mut(row).copy_from_slice(&shares);
    }
    if findings.errors.len() > before {
        return None;
    }
    Some(Rows { axes, map, offset })
}

/// Shares of other joints in the axis of `joint`.
fn couplings(
    place: &KeyPath,
    written: &[ControllerCoupling],
    joint: usize,
    kinds: &[MotionKind],
    names: &[String],
    shares: &mut [f64],
    findings: &mut Findings,
) {
    for (k, coupling) in written.iter().enumerate() {
        let place = place.key("coupled").index(k);
        let Some(other) = findings.keep(actuator(&place, &coupling.joint, names)) else {
            continue;
        };
        if shares[other] != 0.0 || other == joint {
            findings.error(
                &place.key("joint"),
                format!(
                    "the share of '{}' in this axis is given twice",
                    names[other]
                ),
                "write the axis' own joint as joint = ..., every other one once",
            );
        } else if let Some(ratio) =
            findings.keep(share(&place, coupling, kinds[joint], kinds[other]))
        {
            shares[other] = ratio;
        }
    }
}

fn actuator(place: &KeyPath, given: &str, names: &[String]) -> ReadResult<usize> {
    names.iter().position(|n| n == given).ok_or_else(|| {
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        unknown(
            &place.key("joint"),
            "actuator",
            given,
            &known,
            "write the element with actuator = ... in a chain",
        )
    })
}

struct Own {
    ratio: f64,
    offset: f64,
    unit: ControllerUnit,
}

/// The axis' own joint.
fn own(place: &KeyPath, axis: &ControllerAxisTable, kind: MotionKind) -> ReadResult<Own> {
    let ratio = axis.ratio.unwrap_or(1.0);
    if ratio <= 0.0 {
        return Err(Finding::new(
            &place.key("ratio"),
            format!("the ratio is {ratio}, a number above zero is needed"),
            "write reversed = true where the controller counts the other way",
        ));
    }
    let offset = by_kind(
        place,
        "offset of the zero",
        kind,
        &choices!(axis, (zero_offset_mm, MM), (zero_offset_m, 1.0)),
        &choices!(axis, (zero_offset_deg, DEG), (zero_offset_rad, 1.0)),
    )?;
    use ControllerUnit::{Deg, M, Mm, Rad};
    let (usual, other, what) = match kind {
        MotionKind::Prismatic => (Mm, M, "slides"),
        MotionKind::Revolute => (Deg, Rad, "turns"),
    };
    let unit = axis.unit.unwrap_or(usual);
    if unit != usual && unit != other {
        return Err(Finding::new(
            &place.key("unit"),
            format!(
                "'{}' {what}: its unit cannot be {}",
                axis.joint,
                unit.word()
            ),
            format!("write unit = \"{}\" or \"{}\"", usual.word(), other.word()),
        ));
    }
    Ok(Own {
        ratio: if axis.reversed == Some(true) {
            -ratio
        } else {
            ratio
        },
        offset: offset.map_or(0.0, |g| g.value),
        unit,
    })
}

/// The share of another joint in an axis, in m and rad.
fn share(
    place: &KeyPath,
    coupling: &ControllerCoupling,
    axis: MotionKind,
    other: MotionKind,
) -> ReadResult<f64> {
    let same = choice("ratio", coupling.ratio, 1.0);
    let slides = choice("ratio_mm_per_deg", coupling.ratio_mm_per_deg, MM / DEG);
    let turns = choice("ratio_deg_per_mm", coupling.ratio_deg_per_mm, DEG / MM);
    use MotionKind::{Prismatic, Revolute};
    let (right, wrong, reason) = match (axis, other) {
        (Prismatic, Revolute) => (slides, [same, turns], "the axis slides, the joint turns"),
        (Revolute, Prismatic) => (turns, [same, slides], "the axis turns, the joint slides"),
        _ => (same, [slides, turns], "axis and joint are of one kind"),
    };
    forbid(place, &wrong, reason, &format!("write {}", right.key))?;
    let given = need(place, "share", &[right])?;
    if given.value == 0.0 {
        return Err(Finding::new(
            &place.key(given.key),
            "the share is zero",
            "leave this entry out",
        ));
    }
    Ok(given.value)
}

/// The inverse, or a motion of the joints that the controller does not show.
fn inverse(map: &DMatrix<f64>) -> Result<DMatrix<f64>, DVector<f64>> {
    // Units and ratios of very different size are no loss of rank.
    let size = |v: f64| if v > 0.0 { v } else { 1.0 };
    let rows: Vec<f64> = map.row_iter().map(|r| size(r.amax())).collect();
    let mut scaled = DMatrix::from_fn(map.nrows(), map.ncols(), |i, j| map[(i, j)] / rows[i]);
    let columns: Vec<f64> = scaled.column_iter().map(|c| size(c.amax())).collect();
    for (mut column, by) in scaled.column_iter_mut().zip(&columns) {
        column /= *by;
    }
    let singular = kinetostat::linalg::SingularValues::of(&scaled);
    let inverse = (singular.least() > 1e-9 * singular.largest())
        .then(|| scaled.try_inverse())
        .flatten()
        .filter(|m| m.iter().all(|x| x.is_finite()));
    match inverse {
        Some(m) => Ok(DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| {
            m[(i, j)] / columns[i] / rows[j]
        })),
        None => {
            let all = singular.all_right();
            let last = all.column_iter().next_back();
            Err(last.map_or_else(|| DVector::zeros(0), |v| v.into_owned()))
        }
    }
}
