//! Postures at which two machines are compared.

use kinetostat::{Mechanism, MotionKind};

/// Commands at home, m or rad.
pub(crate) fn home(m: &Mechanism) -> Vec<f64> {
    let limbs = m.limbs().iter();
    limbs.flat_map(|l| l.nominal.home_commands()).collect()
}

/// Kinds of all actuators, in the order of their names.
pub(crate) fn kinds(m: &Mechanism) -> Vec<MotionKind> {
    let limbs = m.limbs().iter();
    limbs
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
        .collect()
}

/// Irregular postures around home: a serial arm in all its range (`wide`), a parallel machine near home.
pub(crate) fn postures(
    m: &Mechanism,
    kinds: &[MotionKind],
    wide: bool,
    length: f64,
    count: usize,
) -> Vec<Vec<f64>> {
    let home = home(m);
    let limits = m
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.limits));
    let limits: Vec<Option<(f64, f64)>> = limits.collect();
    (0..count)
        .map(|k| {
            (0..kinds.len())
                .map(|i| {
                    // Golden ratio's multiples, one sequence per joint.
                    let share = ((k * kinds.len() + i + 1) as f64 * 0.618_033_988_75
                        + 0.377 * i as f64)
                        .fract()
                        - 0.5;
                    let reach = match (kinds[i], wide) {
                        (MotionKind::Revolute, true) => 3.0,
                        (MotionKind::Revolute, false) => 0.2,
                        (MotionKind::Prismatic, true) => length,
                        (MotionKind::Prismatic, false) => 0.1 * length,
                    };
                    let value = home[i] + share * reach;
                    match limits[i] {
                        Some((low, high)) => value.clamp(low, high),
                        None => value,
                    }
                })
                .collect()
        })
        .collect()
}
