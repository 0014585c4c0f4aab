//! Figures of a document beside the size of its machine.

use kinetostat::Mechanism;
use kinetostat::number::short;

use crate::elements::placement::pose;
use crate::elements::workspace::corners;
use crate::plausibility::at_home::machine_size;
use crate::plausibility::limb::LimbCheck;
use crate::plausibility::tree::numbers;
use crate::problem::{Finding, KeyPath};
use crate::schema::Document;

/// Looks at figures beside the rest of the machine.
pub(crate) fn of_machine(document: &Document, mechanism: &Mechanism, warnings: &mut Vec<Finding>) {
    let size = machine_size(mechanism);
    // A machine whose axes meet in one point has no size to compare with.
    let sized = size > 0.0 && size.is_finite();
    // Limbs of the same chain would say the same again.
    let mut seen: Vec<&str> = Vec::new();
    for (i, written) in document.limb.iter().enumerate() {
        if seen.contains(&written.chain.as_str()) {
            continue;
        }
        seen.push(&written.chain);
        let check = LimbCheck {
            document,
            mechanism,
            limb: i,
            size,
        };
        check.bodies(warnings);
        if !sized {
            continue;
        }
        check.stiffnesses(warnings);
        check.windup(warnings);
        check.springs6(warnings);
        check.sag(warnings);
        check.masses(warnings);
        check.ranges(warnings);
    }
    if !sized {
        return;
    }
    workspace(document, mechanism, size, warnings);
    deviations(document, size, warnings);
    free_lengths(document, size, warnings);
}

fn workspace(document: &Document, mechanism: &Mechanism, size: f64, warnings: &mut Vec<Finding>) {
    let Ok(Some((a, b))) = corners(document) else {
        return;
    };
    let home = mechanism.platforms()[mechanism.tool()]
        .home
        .translation
        .vector;
    let far = (a - home).norm().max((b - home).norm());
    let extent = (a - b).norm();
    if far > 5.0 * size || extent < 5e-3 * size {
        warnings.push(Finding::new(
            &KeyPath::root().key("workspace"),
            format!(
                "the workspace is {} m large and lies up to {} m from the tool's home, in a machine of {} m",
                short(extent),
                short(far),
                short(size)
            ),
            "check the unit in its keys: _mm or _m",
        ));
    }
}

fn deviations(document: &Document, size: f64, warnings: &mut Vec<Finding>) {
    for (i, deviation) in document.deviation.iter().enumerate() {
        let table = KeyPath::root().key("deviation").index(i);
        let moved =
            (deviation.moved_by.as_ref()).and_then(|m| pose(&table.key("moved_by"), m).ok());
        let (shift, turn, key) = match (moved, deviation.longer_by_mm, deviation.tilted_by_deg) {
            (Some(m), _, _) => (
                m.translation.vector.norm(),
                m.rotation.angle().to_degrees(),
                "moved_by",
            ),
            (_, Some(mm), _) => (1e-3 * mm.abs(), 0.0, "longer_by_mm"),
            (_, _, Some(deg)) => (0.0, deg.abs(), "tilted_by_deg"),
            _ => continue,
        };
        let place = table.key(key);
        if turn > 10.0 || shift > 0.05 * size {
            warnings.push(Finding::new(
                &place,
                format!(
                    "an error of assembly of {} mm and {} degrees",
                    short(1e3 * shift),
                    short(turn)
                ),
                "errors are small motions; check the unit in the key",
            ));
        }
    }
}

/// Springs between points whose free length is nothing beside the machine, but not zero (the ideal compensator),
/// or several machines long.
fn free_lengths(document: &Document, size: f64, warnings: &mut Vec<Finding>) {
    let Ok(tree) = serde_json::to_value(document) else {
        return;
    };
    for number in numbers(&tree) {
        let unit = match number.key {
            "free_length_mm" => 1e-3,
            "free_length_m" => 1.0,
            _ => continue,
        };
        let metres = number.value * unit;
        if metres > 0.0 && !(0.01 * size..=2.0 * size).contains(&metres) {
            warnings.push(Finding::new(
                &number.place,
                format!(
                    "a spring with a free length of {} mm, in a machine of {} m",
                    short(1e3 * metres),
                    short(size)
                ),
                "check the unit in the key: _mm or _m; 0 is the ideal compensator",
            ));
        }
    }
}
