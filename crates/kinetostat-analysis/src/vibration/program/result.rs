//! Result along a program, as plain data for reports and files.

use kinetostat_machining::{ChatterLines, ChatterPlace, ChatterResult};

use crate::vibration::program::along::ProgramChatter;
use crate::vibration::program::judged::{JudgedSite, Verdict};
use crate::vibration::program::stretches::ChatterStretch;

impl ProgramChatter {
    /// Converts to the form in result files, with the law of damping in words.
    #[must_use]
    pub fn result(&self, damping: String) -> ChatterResult {
        let places: Vec<ChatterPlace> = self.sites.iter().map(place).collect();
        let most = |of: fn(&ChatterPlace) -> Option<f64>| {
            let known = places.iter().filter_map(|p| Some((p, of(p)?.abs())));
            known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(p, _)| *p)
        };
        ChatterResult {
            damping,
            places_in_cut: self.places,
            places_judged: self.sites.iter().filter(|site| site.is_judged()).count(),
            stretches: self.stretches.iter().map(lines).collect(),
            nearest: self.nearest().map(place),
            most_shaken: most(|p| p.vibration_rms_um),
            worst_wall: most(|p| p.wall_um),
            places,
        }
    }
}

fn place(judged: &JudgedSite) -> ChatterPlace {
    let (site, forced) = (&judged.site, judged.forced.as_ref());
    ChatterPlace {
        line: site.line,
        path_mm: judged.path_mm,
        rpm: site.station.rpm,
        depth_mm: site.station.depth_mm,
        chatters: match judged.verdict {
            Verdict::Stable => Some(false),
            Verdict::Chatters => Some(true),
            Verdict::NotJudged(_) => None,
        },
        limit_mm: judged.limit_mm,
        looked_up_to_mm: judged.looked_up_to_mm,
        chatter_hz: judged.chatter_hz,
        first_hz: judged.first_hz,
        modes_up_to_hz: judged.modes_up_to_hz,
        force_spread_percent: 100.0 * judged.force_spread,
        vibration_rms_um: forced.map(|f| 1e3 * f.root_mean_square_mm),
        strongest_hz: forced.map(|f| f.strongest_hz),
        nearest_mode_hz: forced.map(|f| f.nearest_mode_hz),
        wall_um: forced.and_then(|f| f.worst_wall_mm()).map(|mm| 1e3 * mm),
    }
}

fn lines(stretch: &ChatterStretch) -> ChatterLines {
    ChatterLines {
        lines: stretch.lines,
        rpm: stretch.rpm,
        depth_mm: stretch.depth_mm,
        stable_depth_mm: stretch.stable_depth_mm,
        stable_rpm: stretch.stable_speed.map(|stable| stable.rpm),
        stable_speed_is_narrow: stretch.stable_speed.is_some_and(|stable| stable.is_narrow),
        stable_feed_mm_per_min: stretch
            .stable_speed
            .and_then(|stable| stable.feed_mm_per_min),
        speeds_tried: stretch.speeds_tried,
        chatter_hz: stretch.chatter_hz,
    }
}
