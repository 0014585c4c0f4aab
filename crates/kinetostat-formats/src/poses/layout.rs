//! Meaning of the names of a row as a whole.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::model::orientation::OrientationText;
use crate::options::LengthUnit;
use crate::poses::columns::{Column, Refusal, column_of, joint_of};

/// A name and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Named {
    pub name: String,
    pub span: Range<usize>,
}

/// Cells of a row by their meaning.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Layout {
    /// X, Y, Z; none in a table of joint values.
    pub position: Option<[usize; 3]>,
    /// Their unit, where the names say it.
    pub unit: Option<LengthUnit>,
    /// In the order of the convention.
    pub orientation: Vec<usize>,
    /// Orientation convention; `None` if no orientation is stated.
    pub convention: Option<OrientationText>,
    /// And how many mm/s one of its unit is.
    pub speed: Option<(usize, f64)>,
    pub rapid: Option<usize>,
    pub raster: Option<usize>,
    pub tool: Option<usize>,
    pub frame: Option<usize>,
    pub external: Vec<usize>,
    /// In the order of the joints, with how many degrees or mm one of the unit is.
    pub joints: Vec<(usize, f64)>,
    /// Cells that are carried unchanged.
    pub carried: Vec<usize>,
}

/// A fault of the names: where, why, what to do.
pub(crate) type NameFault = (Range<usize>, String, String);

fn fault(named: &Named, (reason, remedy): Refusal) -> NameFault {
    (named.span.clone(), reason.to_owned(), remedy.to_owned())
}

/// Layout of a row by its names; `whole` is the span that a missing name is reported at.
///
/// # Errors
/// All faults of the names.
pub(crate) fn layout_of(names: &[Named], whole: &Range<usize>) -> Result<Layout, Vec<NameFault>> {
    let mut faults = Vec::new();
    let mut columns = columns_of(names, &mut faults);
    let places = |column: &Column| matches!(column, Column::Position(..));
    if faults.is_empty() && !columns.iter().any(places) {
        // A table of joint values may name the joints otherwise.
        for (column, named) in columns.iter_mut().zip(names) {
            let joint = joint_of(&named.name).filter(|_| *column == Column::Carried);
            *column = joint.unwrap_or(*column);
        }
    }
    twice(names, &columns, &mut faults);
    let mut layout = Layout::default();
    let mut position = [None; 3];
    let mut turned: BTreeMap<usize, usize> = BTreeMap::new();
    let mut joints: Vec<(Option<usize>, usize, f64)> = Vec::new();
    for (cell, (column, named)) in columns.iter().zip(names).enumerate() {
        match *column {
            Column::Position(axis, unit) => {
                let other = position.iter().any(Option::is_some) && unit != layout.unit;
                position[axis] = position[axis].or(Some(cell));
                if other {
                    faults.push(fault(
                        named,
                        (
                            "a coordinate in another unit than the one before",
                            "write all places in one unit",
                        ),
                    ));
                } else {
                    layout.unit = unit;
                }
            }
            Column::Orientation(convention, place) => match layout.convention {
                Some(before) if before != convention => faults.push(fault(
                    named,
                    (
                        "a second orientation beside another one",
                        "leave one of the two out",
                    ),
                )),
                _ => {
                    layout.convention = Some(convention);
                    turned.entry(place).or_insert(cell);
                }
            },
            Column::Speed(_) if layout.speed.is_some() => {
                faults.push(fault(named, ("a second speed", "leave one of the two out")));
            }
            Column::Speed(factor) => layout.speed = Some((cell, factor)),
            Column::Rapid => layout.rapid = Some(cell),
            Column::Raster => layout.raster = Some(cell),
            Column::Tool => layout.tool = Some(cell),
            Column::Frame => layout.frame = Some(cell),
            Column::External => layout.external.push(cell),
            Column::Joint(number, factor) => joints.push((number, cell, factor)),
            Column::Carried => layout.carried.push(cell),
        }
    }
    if joints.is_empty() || position.iter().any(Option::is_some) {
        complete(&position, &turned, &mut layout, whole, &mut faults);
    }
    joint_order(&mut joints, whole, &mut faults);
    if let (Some((_, cell, _)), Some(_)) = (joints.first(), position.iter().flatten().next()) {
        faults.push(fault(
            &names[*cell],
            (
                "joint values beside poses: which of the two moves the robot is not stated, and joint values do not hold for a corrected pose",
                "leave one of the two out",
            ),
        ));
    }
    layout.joints = joints
        .iter()
        .map(|(_, cell, factor)| (*cell, *factor))
        .collect();
    match faults.is_empty() {
        true => Ok(layout),
        false => {
            faults.sort_by_key(|(span, _, _)| span.start);
            Err(faults)
        }
    }
}

fn columns_of(names: &[Named], faults: &mut Vec<NameFault>) -> Vec<Column> {
    let mut columns = Vec::with_capacity(names.len());
    for named in names {
        columns.push(column_of(&named.name).unwrap_or_else(|refusal| {
            faults.push(fault(named, refusal));
            Column::Carried
        }));
    }
    columns
}

/// Names that stand twice, or mean the same.
fn twice(names: &[Named], columns: &[Column], faults: &mut Vec<NameFault>) {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for (cell, (named, column)) in names.iter().zip(columns).enumerate() {
        if named.name.is_empty() {
            continue;
        }
        let meaning = match column {
            Column::Position(axis, _) => format!("position {axis}"),
            Column::Orientation(convention, place) => format!("{convention:?} {place}"),
            Column::Raster => "raster".to_owned(),
            Column::Frame => "frame".to_owned(),
            _ => named.name.to_ascii_lowercase(),
        };
        if let Some(before) = seen.get(&meaning) {
            let reason = format!(
                "it is stated a second time: `{}` stands before",
                names[*before].name
            );
            let remedy = "leave one of the two out".to_owned();
            faults.push((named.span.clone(), reason, remedy));
        } else {
            seen.insert(meaning, cell);
        }
    }
}

/// Names of the numbers of an orientation, for people.
fn parts(convention: OrientationText) -> &'static [&'static str] {
    match convention {
        OrientationText::Quaternion => &["qw", "qx", "qy", "qz"],
        OrientationText::Abc => &["a_deg", "b_deg", "c_deg"],
        OrientationText::Wpr => &["rx_deg", "ry_deg", "rz_deg"],
        OrientationText::Axis => &["i", "j", "k"],
        OrientationText::RotationVector => &["rx_rad", "ry_rad", "rz_rad"],
        // No list has the others.
        OrientationText::Xyz | OrientationText::Unstated => &[],
    }
}

/// Takes places and orientations that are whole; what is missing is a fault.
fn complete(
    position: &[Option<usize>; 3],
    turned: &BTreeMap<usize, usize>,
    layout: &mut Layout,
    whole: &Range<usize>,
    faults: &mut Vec<NameFault>,
) {
    let mut missing: Vec<&str> = Vec::new();
    match *position {
        [Some(x), Some(y), Some(z)] => layout.position = Some([x, y, z]),
        [None, None, None] if faults.is_empty() => faults.push((
            whole.clone(),
            "no place is named".to_owned(),
            "name the columns with their units: x_mm, y_mm, z_mm (or x_m, y_m, z_m), or joint_1_deg, joint_2_deg, ...; then qw, qx, qy, qz, or rx_deg, ry_deg, rz_deg, or i, j, k, where the orientation is stated".to_owned(),
        )),
        [None, None, None] => {}
        _ => {
            let absent = position.iter().zip(["x", "y", "z"]);
            missing.extend(absent.filter(|(cell, _)| cell.is_none()).map(|(_, name)| name));
        }
    }
    let named = layout.convention.map_or(&[][..], parts);
    for (place, name) in named.iter().enumerate() {
        match turned.get(&place) {
            Some(cell) => layout.orientation.push(*cell),
            None => missing.push(name),
        }
    }
    // A name that was refused may be the one that is missing.
    if !missing.is_empty() && faults.is_empty() {
        faults.push((
            whole.clone(),
            format!("not stated: {}", missing.join(", ")),
            "state all of them".to_owned(),
        ));
    }
}

/// Numbered joints are 1, 2, 3, ... or 0, 1, 2, ...; others stand in the order of their columns.
fn joint_order(
    joints: &mut [(Option<usize>, usize, f64)],
    whole: &Range<usize>,
    faults: &mut Vec<NameFault>,
) {
    let numbers: Vec<usize> = joints.iter().filter_map(|(number, _, _)| *number).collect();
    let ascend = numbers.windows(2).all(|pair| pair[0] < pair[1]);
    if numbers.is_empty() || numbers.len() < joints.len() && ascend {
        return;
    }
    joints.sort_by_key(|(number, cell, _)| (*number, *cell));
    let counted_from = |first: usize| {
        let mut all = joints.iter().enumerate();
        all.all(|(index, (number, _, _))| *number == Some(first + index))
    };
    let counted = counted_from(1) || counted_from(0);
    if !counted && faults.is_empty() {
        faults.push((
            whole.clone(),
            "the joints are not numbered 1, 2, 3, ...".to_owned(),
            "name them joint_1_deg, joint_2_deg, ..., all of them; external axes have no place in it".to_owned(),
        ));
    }
}
