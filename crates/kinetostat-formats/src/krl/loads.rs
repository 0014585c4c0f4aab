//! The loads of tools that programs and data lists state: `LOAD_DATA[4]={M 5.5,CM {X 0,Y 0,Z 60,A 0,B 0,C 0},J {X 0.1,Y 0.1,Z 0.05}}`.
//!
//! Source: KUKA System Software 8.x, Operating and Programming Instructions for System Integrators: mass in kg, centre of mass and axes
//! of the moments of inertia in axes of the flange, moments about these axes through the centre of mass in kg m^2.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use nalgebra::Vector3;

use crate::interpreter::token::TokenFile;
use crate::krl::aggregate::{aggregate_of, place_of};
use crate::krl::lex::{assignment, token_file};
use crate::model::orientation::OrientationText;
use crate::model::tool_load::ToolLoad;
use crate::text::source::SourceFile;

/// Loads by tool number; a tool with conflicting loads is left out, and no load is known if `$LOAD` is not set from the array.
pub(crate) fn tool_loads(files: &[SourceFile]) -> BTreeMap<u32, ToolLoad> {
    let mut found: BTreeMap<u32, Option<ToolLoad>> = BTreeMap::new();
    for (index, source) in files.iter().enumerate() {
        let file = token_file(index, source);
        for line in &file.lines {
            let Some(equals) = assignment(&file, &line.tokens) else {
                continue;
            };
            let value = equals + 1..line.tokens.end;
            let (is_of_array, sets) = match file.name(line.tokens.start) {
                Some(name) if name.is("$LOAD") => {
                    let from = file.name(value.start);
                    (false, from.is_none_or(|from| !from.is("LOAD_DATA")))
                }
                Some(name) => (name.is("LOAD_DATA"), false),
                None => continue,
            };
            if sets {
                return BTreeMap::new();
            }
            if !is_of_array {
                continue;
            }
            let (place, number) = place_of(&file, line.tokens.start, equals);
            let Some(number) = number.filter(|_| place.len() > 1) else {
                return BTreeMap::new();
            };
            let is_whole = place == (line.tokens.start..equals);
            let load = load_of(&file, &value).filter(|_| is_whole);
            match found.entry(number) {
                Entry::Vacant(place) => {
                    place.insert(load);
                }
                Entry::Occupied(mut known) if *known.get() != load => {
                    known.insert(None);
                }
                Entry::Occupied(_) => {}
            }
        }
    }
    let known = found.into_iter();
    known
        .filter_map(|(number, load)| Some((number, load?)))
        .collect()
}

fn load_of(file: &TokenFile<'_>, value: &Range<usize>) -> Option<ToolLoad> {
    let load = aggregate_of(file, value)?;
    let centre = aggregate_of(file, load.member("CM")?)?;
    let moments = aggregate_of(file, load.member("J")?)?;
    let [x, y, z, a, b, c] = ["X", "Y", "Z", "A", "B", "C"].map(|name| centre.number(file, name));
    let [jx, jy, jz] = ["X", "Y", "Z"].map(|name| moments.number(file, name));
    Some(ToolLoad {
        mass_kg: load.number(file, "M")?,
        centre_of_mass_mm: Vector3::new(x?, y?, z?),
        axes_of_moment: OrientationText::Abc.rotation_of(&[a?, b?, c?])?,
        inertia_kg_m2: Vector3::new(jx?, jy?, jz?),
    })
}
