//! Numbers and vectors as people read them.

use kinetostat::Pose;
use kinetostat::number::largest_size;
use kinetostat_machining::number as formatter;
use kinetostat_machining::number::without_zeros;

/// A number with `digits` significant digits, for tables: the one formatter of all commands and of the
/// report, in engineering notation where plain notation would be long.
pub(crate) fn number(value: f64, digits: i32) -> String {
    let digits = usize::try_from(digits).unwrap_or(1);
    formatter::significant(value, digits, formatter::Rounding::Nearest)
}

/// A number with fixed decimals, for components beside each other; never `-0.000`.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    formatter::fixed(value, decimals)
}

/// A number that was given, as short as it can be at six digits.
pub(crate) fn given(value: f64) -> String {
    without_zeros(&number(value, 6)).to_owned()
}

/// Components of a load in brackets, at four decimals, small ones with three digits; what is rounding beside the
/// largest is zero.
pub(crate) fn load_triple(v: [f64; 3]) -> String {
    let most = largest_size(v);
    triple(v, |x| match x.abs() <= 1e-12 * most {
        true => "0".to_owned(),
        false if x.abs() < 0.01 => formatter::short(x),
        false => short(x),
    })
}

/// Three components in brackets.
pub(crate) fn triple(v: [f64; 3], shown: impl Fn(f64) -> String) -> String {
    format!("({}, {}, {})", shown(v[0]), shown(v[1]), shown(v[2]))
}

/// A number as short as it can be at four decimals.
pub(crate) fn short(value: f64) -> String {
    without_zeros(&fixed(value, 4)).to_owned()
}

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
