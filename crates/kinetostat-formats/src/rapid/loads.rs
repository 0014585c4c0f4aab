//! The loads of tools, which `tooldata` declares with their tips.

use std::collections::BTreeMap;

use nalgebra::{UnitQuaternion, Vector3};

use crate::model::orientation::OrientationText;
use crate::rapid::expression::{Expression, Value, expression_of};
use crate::rapid::lex::tokens_of;
use crate::rapid::literals::values;
use crate::rapid::parser::modules::modules_of;
use crate::rapid::tree::{DatumNode, TokenFile};
use crate::text::name::Name;
use crate::text::source::SourceFile;

/// `loaddata`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ToolLoad {
    pub mass_kg: f64,
    /// In axes of the flange, mm.
    pub centre_of_mass_mm: Vector3<f64>,
    /// Turns the axes of the flange into those of the moments of inertia.
    pub axes_of_moment: UnitQuaternion<f64>,
    /// About those axes through the centre of mass, kg m^2.
    pub inertia_kg_m2: Vector3<f64>,
}

/// The loads of tools whose declaration is a literal, by their names; none of a name that is declared with different ones.
pub(crate) fn tool_loads(files: &[SourceFile]) -> BTreeMap<Name, ToolLoad> {
    let mut found: BTreeMap<Name, Option<ToolLoad>> = BTreeMap::new();
    for (index, source) in files.iter().enumerate() {
        let file = TokenFile {
            index,
            source,
            tokens: tokens_of(source.bytes()),
        };
        for module in modules_of(&file, &mut Vec::new()) {
            let of_routines = module.routines.iter().flat_map(|routine| &routine.data);
            for node in module.data.iter().chain(of_routines) {
                if !node.type_name.is("TOOLDATA") {
                    continue;
                }
                let load = load_of(&file, node);
                let known = found.entry(node.name).or_insert(load);
                if *known != load {
                    *known = None;
                }
            }
        }
    }
    let known = found.into_iter();
    known
        .filter_map(|(name, load)| Some((name, load?)))
        .collect()
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
