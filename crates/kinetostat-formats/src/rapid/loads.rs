//! Declarations other than frames of motions: loads of tools, the two frames of work objects.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use nalgebra::{Isometry3, Vector3};

use crate::interpreter::evaluate::{LiteralsOnly, evaluate};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::DatumNode;
use crate::interpreter::value::Datum;
use crate::model::tool_load::ToolLoad;
use crate::rapid::expression::expression_of;
use crate::rapid::lex::tokens_of;
use crate::rapid::literals::{frame_of, rotation_of};
use crate::rapid::parser::modules::modules_of;
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
