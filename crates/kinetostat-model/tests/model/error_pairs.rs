//! Errors in pairs: two errors of manufacture at two elements add up, and two at one element are refused, never dropped.

use kinetostat::nalgebra::Vector3;
use kinetostat::{Pose, Wrench};
use kinetostat_model::Model;
use kinetostat_model::schema::{Axis, AxisName, Deviation, Placement};

/// Machines with open and with closed loops.
const MACHINES: [&str; 5] = ["orthoglide", "heavy_6r", "scara", "delta", "tripteron"];

/// Sizes of errors, mm and degrees: so small that what is not linear in them is far below them.
const LARGEST: f64 = 0.02;

/// Part of both shifts that may come of what is not linear.
const NOT_LINEAR: f64 = 0.02;

/// Two errors together move the tool by their product, too, which is all there is where neither moves it alone to first order
/// (a leg that is longer along a direction which only the other's tilt makes count). A shift turns a member, and a tilt shifts its
/// end. The shortest and the longest of these members in the machines above, m.
const SHORTEST: f64 = 0.2;
const LONGEST: f64 = 1.0;

/// Shifts that are rounding, m.
const ROUNDING: f64 = 1e-10;

/// Numbers from 0 to 1 (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }

    fn error(&mut self, model: &Model) -> Deviation {
        let limb = &model.document.limb[self.below(model.document.limb.len())];
        let elements = &model.document.chain[&limb.chain].elements;
        let mut places = vec!["start", "end"];
        places.extend(elements.iter().filter_map(|e| e.name()));
        let mut error = Deviation {
            limb: limb.name.clone(),
            at: places[self.below(places.len())].to_owned(),
            ..Deviation::default()
        };
        let mut size = || LARGEST * (2.0 * self.next() - 1.0);
        let shift = [size(), size(), size()];
        match self.below(3) {
            0 => error.longer_by_mm = Some(shift[0]),
            1 => {
                error.tilted_by_deg = Some(shift[1]);
                let axes = [AxisName::X, AxisName::Y, AxisName::Z];
                error.about = Some(Axis::Named(axes[self.below(3)]));
            }
            _ => {
                error.moved_by = Some(Placement {
                    translation_mm: Some(shift),
                    ..Placement::default()
                });
            }
        }
        error
    }

    /// An error that the machine can have, with the machine that has it.
    fn possible(&mut self, model: &Model) -> (Deviation, Model) {
        loop {
            let error = self.error(model);
            if let Ok(made) = model.deviating(error.clone()) {
                return (error, made);
            }
        }
    }
}

/// Size of an error, m: of a tilt the shift of the end of a long member.
fn size(error: &Deviation) -> f64 {
    let moved = error.moved_by.as_ref().and_then(|by| by.translation_mm);
    let shift =
        moved.map_or(0.0, |mm| Vector3::from(mm).norm()) + error.longer_by_mm.unwrap_or(0.0).abs();
    1e-3 * shift + LONGEST * error.tilted_by_deg.unwrap_or(0.0).to_radians().abs()
}

/// Place of the tool without a load, commanded as the machine as drawn.
fn place(model: &Model) -> Result<Vector3<f64>, String> {
    let machine = &model.mechanism;
    let home: Pose = machine.platforms()[machine.tool()].home;
    let posture = machine.posture(&home).map_err(|e| e.to_string())?;
    let found = posture.deflected_by(&Wrench::zero());
    let found = found.map_err(|e| e.to_string())?;
    Ok(found.state.platforms[machine.tool()].translation.vector)
}

/// One pair of errors. Returns how far both together are from the sum of each, as a part of what is allowed.
pub fn check(seed: u64) -> Result<f64, String> {
    let mut random = Random(seed);
    let name = MACHINES[random.below(MACHINES.len())];
    let model = Model::preset(name).map_err(|e| e.to_string())?;
    let (first, with_first) = random.possible(&model);
    let (second, with_second) = random.possible(&model);
    let told = |what: &str| format!("seed {seed}, {name}: {what}: {first:?}, {second:?}");
    let both = with_first.deviating(second.clone());
    let swapped = with_second.deviating(first.clone());
    if (&first.limb, &first.at) == (&second.limb, &second.at) {
        let refused = |made: &Result<Model, _>| match made {
            Ok(_) => false,
            Err(error) => format!("{error}").contains("already"),
        };
        return match refused(&both) && refused(&swapped) {
            true => Ok(0.0),
            false => Err(told("a second error of one element is not refused")),
        };
    }
    let (both, swapped) = match (both, swapped) {
        (Ok(both), Ok(swapped)) => (both, swapped),
        // Two names of one joint.
        (Err(error), Err(_)) if error.to_string().contains("already") => return Ok(0.0),
        _ => return Err(told("one order is taken and the other is not")),
    };
    if both.mechanism != swapped.mechanism {
        return Err(told("the order of two errors counts"));
    }
    let drawn = place(&model)?;
    let shift = |model: &Model| Ok::<_, String>(place(model)? - drawn);
    let (one, other, together) = (shift(&with_first)?, shift(&with_second)?, shift(&both)?);
    let product = size(&first) * size(&second) / SHORTEST;
    let allowed = NOT_LINEAR * (one.norm() + other.norm()) + product + ROUNDING;
    let off = (together - one - other).norm() / allowed;
    match off <= 1.0 {
        true => Ok(off),
        // NaN is a fault, too.
        false => Err(told(&format!(
            "both move the tool by {together:?} m, alone by {one:?} and {other:?}"
        ))),
    }
}

#[test]
fn errors_in_pairs_add_up_or_are_refused() {
    let mut worst = kinetostat_testing::Worst::new();
    for seed in 0..150 {
        worst.add(check(seed).unwrap_or_else(|fault| panic!("{fault}")));
    }
    assert!(worst.holds(1.0), "{worst}");
}
