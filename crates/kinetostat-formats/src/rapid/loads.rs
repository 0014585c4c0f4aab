//! What declarations say beside the frames that motions use: the loads of tools, the two frames of work objects.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use nalgebra::{Isometry3, Vector3};

use crate::model::orientation::OrientationText;
use crate::model::tool_load::ToolLoad;
use crate::rapid::expression::{Expression, Value, expression_of};
use crate::rapid::lex::tokens_of;
use crate::rapid::literals::{frame_of, values};
use crate::rapid::parser::modules::modules_of;
use crate::rapid::tree::{DatumNode, TokenFile};
use crate::text::name::Name;
use crate::text::source::SourceFile;

/// The loads of tools whose declaration is a literal, by their names; none of a name that is declared with different ones.
pub(crate) fn tool_loads(files: &[SourceFile]) -> BTreeMap<Name, ToolLoad> {
    literals(files, "TOOLDATA", load_of)
}

/// The user frame and the object frame of work objects that have both.
pub(crate) fn object_frames(files: &[SourceFile]) -> BTreeMap<Name, [Isometry3<f64>; 2]> {
    literals(files, "WOBJDATA", frames_of)
}

/// What literals of a type declare, by their names; nothing of a name that is declared with different ones.
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

/// `[robhold, ufprog, ufmec, uframe, oframe]`.
fn frames_of(file: &TokenFile<'_>, node: &DatumNode) -> Option<[Isometry3<f64>; 2]> {
    let Value::List(parts) = expression_of(file, node.initial.clone()?).value else {
        return None;
    };
    let [_, _, _, user, object] = parts.as_slice() else {
        return None;
    };
    let frames = [frame_of(user)?, frame_of(object)?];
    let is_some = |frame: &Isometry3<f64>| *frame != Isometry3::identity();
    frames.iter().all(is_some).then_some(frames)
}

/// `[robhold, tframe, [mass, cog, aom, ix, iy, iz]]`.
fn load_of(file: &TokenFile<'_>, node: &DatumNode) -> Option<ToolLoad> {
    let list = |expression: &Expression| match &expression.value {
        Value::List(parts) => Some(parts.clone()),
        _ => None,
    };
    let number = |expression: &Expression| match expression.value {
        Value::Number(value) => Some(value),
        _ => None,
    };
    let tool = list(&expression_of(file, node.initial.clone()?))?;
    let [_, _, load] = tool.as_slice() else {
        return None;
    };
    let load = list(load)?;
    let [mass, centre, axes, ix, iy, iz] = load.as_slice() else {
        return None;
    };
    Some(ToolLoad {
        mass_kg: number(mass)?,
        centre_of_mass_mm: Vector3::from(values::<3>(centre)?),
        axes_of_moment: OrientationText::Quaternion.rotation_of(&values::<4>(axes)?)?,
        inertia_kg_m2: Vector3::new(number(ix)?, number(iy)?, number(iz)?),
    })
}
