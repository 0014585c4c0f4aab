//! Warnings of displacements that no machine makes, and of machines that snap.

use kinetostat::Wrench;
use kinetostat::error::LoadLimit;
use kinetostat_machining::{Limits, Warning, WarningCode, large_load};
use nalgebra::Vector3;

use crate::ui::numbers::{fixed, number, triple};

/// A chain that is turned over moves its tip by twice its length: what goes further is stretched.
const STRETCHED: f64 = 2.5;

/// The machine is not stable under its load, `places` of a grid in words; empty for one place.
pub(crate) fn not_stable(places: &str) -> Warning {
    Warning::new(
        WarningCode::NotStable,
        format!("the machine does NOT stay in its shape under this load{places}"),
    )
}

/// The tool goes by `far`, further than a machine of this size can, m.
pub(crate) fn stretches(far: f64, size: f64) -> Option<Warning> {
    (far > STRETCHED * size).then(|| {
        Warning::new(WarningCode::LargeDisplacement, format!(
            "the tool goes {} times as far as the machine is long: its springs are stretched beyond all sense; check the range and its unit",
            number(far / size, 2)
        ))
    })
}

/// A motion that is prescribed may take more force than a cut has: only so many times as much is warned of.
const REACTION: f64 = 10.0;

/// Warns of a force, N, for holding or pushing the tool that no machine bears.
pub(crate) fn large_reaction(force: f64) -> Vec<Warning> {
    match force <= REACTION * Limits::default().force_n {
        true => Vec::new(),
        false => large_load(&Wrench::new(Vector3::x() * force, Vector3::zeros())),
    }
}

/// The answer lies beyond a limit point of the load.
pub(crate) fn snaps(limit: &LoadLimit) -> Warning {
    let d = 1e3 * limit.displacement.linear();
    let said = format!(
        "the machine SNAPS on the way to this load: from rest it carries only {} of it, up to a limit point of the load at {} mm; what is reported here is another equilibrium beyond it. `kinetostat curve` shows the path, `kinetostat equilibria` all of them",
        number(limit.share, 4),
        triple(d.into(), |x| fixed(x, 4))
    );
    Warning::new(WarningCode::Snaps, said)
}
