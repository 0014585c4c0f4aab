//! Poses as people copy them.

use kinetostat::Pose;

use crate::ui::numbers::triple;

/// A pose to copy: `position (0, 760, 0) mm, rotation vector (0, 0, 53.13) deg`.
pub(crate) fn pose_text(pose: &Pose) -> String {
    let clean = |x: f64| (x * 1e6).round() / 1e6 + 0.0;
    format!(
        "position {} mm, rotation vector {} deg",
        triple((pose.translation.vector * 1e3).into(), |x| clean(x)
            .to_string()),
        triple(
            pose.rotation.scaled_axis().map(f64::to_degrees).into(),
            |x| clean(x).to_string()
        )
    )
}
