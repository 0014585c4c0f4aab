//! Targets, frames, joints and loads as aggregates of numbers: `[[x,y,z],[q1,q2,q3,q4],[cf1,cf4,cf6,cfx],[eax_a,...]]`.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::interpreter::evaluate::{LiteralsOnly, evaluate};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::DatumNode;
use crate::interpreter::value::{Datum, Literal};
use crate::model::motion::ToolLoad;
use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::model::target::{Configuration, PoseTarget};
use crate::rapid::lex::{expression_of, tokens_of};
use crate::rapid::parser::modules::modules_of;
use crate::text::Name;
use crate::text::number::{NumberText, Width};
use crate::text::source::SourceFile;

/// Threshold above which an external axis is not stated: 9E9.
const UNSTATED: f64 = 8e9;

/// The pose that a robtarget is, or why it is none. `files` have the text of its configuration.
pub(crate) fn pose_of(files: &[TokenFile<'_>], datum: &Datum) -> Result<PoseTarget, String> {
    if let Some(reason) = datum.unknown_reason() {
        return Err(reason.to_string());
    }
    let [position, orientation, configuration, external] = datum.parts() else {
        return Err(
            "a robtarget has four parts: place, orientation, configuration, external axes"
                .to_owned(),
        );
    };
    let position = (position.as_numbers::<3>()).ok_or("its place is not three numbers")?;
    let turn = (orientation.as_numbers::<4>()).ok_or("its orientation is not four numbers")?;
    let orientation = (OrientationText::Quaternion.rotation_of(&turn))
        .ok_or("its quaternion has not the length 1")?;
    let axes = (external.as_numbers::<6>()).ok_or("its external axes are not six numbers")?;
    let numbers = (configuration.as_numbers::<4>())
        .filter(|all| all.iter().all(is_quarter))
        .ok_or("its configuration is not four whole numbers")?;
    let written = configuration.literal.and_then(|literal| {
        let file = files.get(literal.file)?;
        Some(String::from_utf8_lossy(file.source.part(&literal.span())).into_owned())
    });
    let text = written.unwrap_or_else(|| {
        let parts = numbers.iter().map(f64::to_string);
        format!("[{}]", parts.collect::<Vec<String>>().join(","))
    });
    Ok(PoseTarget {
        position_mm: Vector3::from(position),
        orientation,
        configuration: Configuration {
            text,
            numbers: numbers.to_vec(),
        },
        external: stated(axes),
    })
}

/// All numbers of a list, where they stand as numbers in these bytes of a file.
pub(crate) fn numbers_in(
    datum: &Datum,
    file: usize,
    span: &Range<usize>,
) -> Option<Vec<NumberText>> {
    let parts = datum.parts().iter();
    parts.map(|part| part.number_in(file, span)).collect()
}

/// The literal of a robtarget, where all numbers of its place, orientation and external axes stand in it.
pub(crate) fn text_of(datum: &Datum) -> Option<PoseText> {
    let Literal { file, .. } = datum.literal?;
    let whole = datum.literal?.span();
    let [position, orientation, _, external] = datum.parts() else {
        return None;
    };
    let axes = numbers_in(external, file, &whole)?;
    Some(PoseText {
        file,
        position: numbers_in(position, file, &whole)?.try_into().ok()?,
        orientation: numbers_in(orientation, file, &whole)?,
        unit_mm: 1.0,
        convention: OrientationText::Quaternion,
        external: (axes.into_iter())
            .map(|number| is_stated(number.value).then_some(number))
            .collect(),
        width: Width::Free,
        whole,
    })
}

/// True if a number counts quarters of a turn, or is a sum of flags.
fn is_quarter(value: &f64) -> bool {
    value.fract() == 0.0 && value.abs() < 1e10
}

/// True if a number is the place of an external axis, and not 9E9.
fn is_stated(value: f64) -> bool {
    value < UNSTATED
}

fn stated(axes: [f64; 6]) -> Vec<Option<f64>> {
    axes.map(|value| is_stated(value).then_some(value)).to_vec()
}

/// A jointtarget: joints in degrees, external axes.
pub(crate) fn joints_of(datum: &Datum) -> Option<(Vec<f64>, Vec<Option<f64>>)> {
    let [joints, external] = datum.parts() else {
        return None;
    };
    let axes = external.as_numbers::<6>().map_or_else(Vec::new, stated);
    Some((joints.as_numbers::<6>()?.to_vec(), axes))
}

/// The rotation of an orient: four numbers.
pub(crate) fn rotation_of(datum: &Datum) -> Option<UnitQuaternion<f64>> {
    OrientationText::Quaternion.rotation_of(&datum.as_numbers::<4>()?)
}

/// A pose: `[[x,y,z],[q1,q2,q3,q4]]`.
pub(crate) fn frame_of(datum: &Datum) -> Option<Isometry3<f64>> {
    let [place, orientation] = datum.parts() else {
        return None;
    };
    let place = Translation3::from(Vector3::from(place.as_numbers::<3>()?));
    Some(Isometry3::from_parts(place, rotation_of(orientation)?))
}

/// The list of a rotation.
pub(crate) fn orient_of(rotation: &UnitQuaternion<f64>) -> Datum {
    Datum::numbers([rotation.w, rotation.i, rotation.j, rotation.k])
}

/// The list of a pose.
pub(crate) fn list_of_frame(frame: &Isometry3<f64>) -> Datum {
    let place = Datum::numbers(frame.translation.vector.iter().copied());
    Datum::list(vec![place, orient_of(&frame.rotation)])
}

/// The index of a component in an aggregate of so many parts, by its name.
///
/// Source: ABB, RAPID Instructions, Functions and Data types, the pages of the data types.
pub(crate) fn component(name: &str, parts: usize) -> Option<usize> {
    const NAMES: [&[&str]; 12] = [
        &["TRANS", "ROT", "ROBCONF", "EXTAX"],
        &["ROBAX", "EXTAX"],
        &["X", "Y", "Z"],
        &["Q1", "Q2", "Q3", "Q4"],
        &["CF1", "CF4", "CF6", "CFX"],
        &["EAX_A", "EAX_B", "EAX_C", "EAX_D", "EAX_E", "EAX_F"],
        &["RAX_1", "RAX_2", "RAX_3", "RAX_4", "RAX_5", "RAX_6"],
        &["ROBHOLD", "TFRAME", "TLOAD"],
        &["ROBHOLD", "UFPROG", "UFMEC", "UFRAME", "OFRAME"],
        &["V_TCP", "V_ORI", "V_LEAX", "V_REAX"],
        &["MASS", "COG", "AOM", "IX", "IY", "IZ"],
        &[
            "FINEP",
            "PZONE_TCP",
            "PZONE_ORI",
            "PZONE_EAX",
            "ZONE_ORI",
            "ZONE_LEAX",
            "ZONE_REAX",
        ],
    ];
    let place = |names: &&[&str]| names.iter().position(|own| *own == name);
    let of_size = NAMES.iter().filter(|names| names.len() == parts);
    let mut found = of_size.filter_map(place);
    // `pose` has the first two components of a robtarget; a value that is not there yet has any.
    found
        .next()
        .or_else(|| NAMES.iter().find_map(place).filter(|_| parts <= 2))
}

/// The loads of tools whose declaration is a literal, by their names; none of a name that is declared with different ones.
pub(crate) fn tool_loads(files: &[SourceFile]) -> BTreeMap<Name, ToolLoad> {
    literals(files, "TOOLDATA", load_of)
}

/// The user frame and the object frame of work objects that have both.
pub(crate) fn object_frames(files: &[SourceFile]) -> BTreeMap<Name, [Isometry3<f64>; 2]> {
    literals(files, "WOBJDATA", frames_of)
}

/// Literals of a type by their names; a name that is declared with different ones is left out.
fn literals<T: PartialEq>(
    files: &[SourceFile],
    type_name: &str,
    read: impl Fn(&TokenFile<'_>, &DatumNode) -> Option<T>,
) -> BTreeMap<Name, T> {
    let mut found: BTreeMap<Name, Option<T>> = BTreeMap::new();
    for (index, source) in files.iter().enumerate() {
        let file = TokenFile {
            index,
            source,
            tokens: tokens_of(source.bytes()),
            lines: Vec::new(),
        };
        for module in modules_of(&file, &mut Vec::new()) {
            let of_routines = module.routines.iter().flat_map(|routine| &routine.data);
            let all = module.data.iter().chain(of_routines);
            for node in all.filter(|node| node.type_name.is(type_name)) {
                let value = read(&file, node);
                match found.entry(node.name) {
                    Entry::Vacant(place) => {
                        place.insert(value);
                    }
                    Entry::Occupied(mut known) if *known.get() != value => {
                        known.insert(None);
                    }
                    Entry::Occupied(_) => {}
                }
            }
        }
    }
    let known = found.into_iter();
    known
        .filter_map(|(name, value)| Some((name, value?)))
        .collect()
}

/// The first value of a declaration, in literals alone.
fn initial(file: &TokenFile<'_>, node: &DatumNode) -> Option<Datum> {
    let expression = expression_of(file, node.initial.clone()?);
    Some(evaluate(file, &expression, &mut LiteralsOnly))
}

/// `[robhold, ufprog, ufmec, uframe, oframe]`.
fn frames_of(file: &TokenFile<'_>, node: &DatumNode) -> Option<[Isometry3<f64>; 2]> {
    let object = initial(file, node)?;
    let [_, _, _, user, object] = object.parts() else {
        return None;
    };
    let frames = [frame_of(user)?, frame_of(object)?];
    let is_some = |frame: &Isometry3<f64>| *frame != Isometry3::identity();
    frames.iter().all(is_some).then_some(frames)
}

/// `[robhold, tframe, [mass, cog, aom, ix, iy, iz]]`.
fn load_of(file: &TokenFile<'_>, node: &DatumNode) -> Option<ToolLoad> {
    let tool = initial(file, node)?;
    let [_, _, load] = tool.parts() else {
        return None;
    };
    let [mass, centre, axes, ix, iy, iz] = load.parts() else {
        return None;
    };
    let inertia = Vector3::new(ix.as_number()?, iy.as_number()?, iz.as_number()?);
    Some(ToolLoad {
        mass_kg: mass.as_number()?,
        centre_of_mass_mm: Vector3::from(centre.as_numbers::<3>()?),
        axes_of_moment: rotation_of(axes)?,
        inertia_kg_m2: inertia,
    })
}
