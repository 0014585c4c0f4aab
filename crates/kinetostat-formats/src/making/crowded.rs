//! Motions that follow one another faster than an arm's controller plans them.

use std::collections::VecDeque;

use crate::making::fault::MakeFinding;
use crate::making::step::{MadeMotion, Step, Way};

/// Window of consecutive motions: look-ahead compensates a single short one.
const IN_A_ROW: usize = 16;

/// The time of a motion that controllers of arms plan without slowing down, s: KUKA interpolates every 4 or 12 ms, FANUC every 8 ms.
const SHORTEST_S: f64 = 0.008;

/// The feeds of a program that are too short for their speed, in words; none where all are long enough.
pub(crate) fn crowded(steps: &[Step]) -> Option<MakeFinding> {
    let mut window: VecDeque<f64> = VecDeque::new();
    let (mut count, mut most_per_s, mut shortest_mm) = (0, 0.0, f64::INFINITY);
    let mut first = None;
    let mut from: Option<&MadeMotion> = None;
    for step in steps {
        let Step::Motion(motion) = step else {
            if !matches!(step, Step::Note(_)) {
                window.clear();
            }
            continue;
        };
        let way_mm = from.map_or(0.0, |from| (motion.end - from.end).norm());
        from = Some(motion);
        if motion.rapid || motion.way != Way::Line || way_mm == 0.0 {
            window.clear();
            continue;
        }
        let time_s = way_mm / motion.speed_mm_per_s;
        if time_s < SHORTEST_S {
            count += 1;
            if way_mm < shortest_mm {
                shortest_mm = way_mm;
            }
        }
        window.push_back(time_s);
        if window.len() > IN_A_ROW {
            window.pop_front();
        }
        let rate = IN_A_ROW as f64 / window.iter().sum::<f64>();
        if window.len() == IN_A_ROW && rate > 1.0 / SHORTEST_S {
            first.get_or_insert(motion.line);
            if rate > most_per_s {
                most_per_s = rate;
            }
        }
    }
    first.map(|line| {
        MakeFinding::of(
            line,
            format!(
                "{count} motions are shorter than {:.0} ms at their speed, the shortest {shortest_mm:.3} mm, up to {most_per_s:.0} of them in a second, here first: an arm may slow down there; let the CAM system write longer ones (a wider tolerance of its chords), or cut more slowly",
                1e3 * SHORTEST_S
            ),
        )
    })
}
