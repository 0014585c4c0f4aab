//! The answer of `chatter`, stable names with units.

use kinetostat_analysis::vibration::program::{
    ForcedVibration, JudgedSite, ProgramChatter, Verdict,
};
use kinetostat_chatter::Instability;
use kinetostat_machining::{FlatProgram, Warning};

use schemars::JsonSchema;
use serde::Serialize;

use crate::job::chatter::ChatterSetting;
use crate::job::machine::MachineSetup;
use crate::program::chatter::limits;

#[derive(Serialize, JsonSchema)]
pub(crate) struct ChatterAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) program: String,
    pub(crate) model: String,
    pub(crate) material: String,
    /// Damping in words.
    pub(crate) damping: String,
    /// Fastest mode that swings at any place; those above count by their flexibility at rest.
    pub(crate) modes_up_to_hz: Option<f64>,
    /// Places of the program at which the tool cuts.
    pub(crate) places_in_cut: usize,
    pub(crate) places_judged: usize,
    /// True if a judged place chatters.
    pub(crate) chatters: bool,
    /// The place with the least limit by its depth.
    pub(crate) nearest: Option<Place>,
    /// Stretches that chatter, in the order of the program.
    pub(crate) stretches: Vec<Stretch>,
    pub(crate) places: Vec<Place>,
    pub(crate) warnings: Vec<Warning>,
}

/// A place of the program, for those that are like it.
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct Place {
    pub(crate) line: usize,
    /// File and line of origin, if the program was expanded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) source: Option<String>,
    pub(crate) path_mm: f64,
    /// Part frame.
    pub(crate) position_mm: [f64; 3],
    pub(crate) rpm: f64,
    pub(crate) depth_mm: f64,
    /// Arc in contact: 0 is to the left of the feed, 90 ahead.
    pub(crate) entry_deg: Option<f64>,
    pub(crate) exit_deg: Option<f64>,
    pub(crate) feed_per_tooth_mm: f64,
    /// `stable`, `chatters`, or `not judged`.
    pub(crate) verdict: &'static str,
    pub(crate) reason: Option<String>,
    /// Depth at which the cut becomes unstable at this speed; null: not up to `looked_up_to_mm`.
    pub(crate) limit_mm: Option<f64>,
    pub(crate) looked_up_to_mm: f64,
    pub(crate) chatter_hz: Option<f64>,
    /// `flip` or `hopf`.
    pub(crate) kind: Option<Instability>,
    /// Lowest frequency of the machine there.
    pub(crate) first_hz: Option<f64>,
    /// Fastest mode that swings in the calculation.
    pub(crate) modes_up_to_hz: Option<f64>,
    /// Spread of the force about the material law.
    pub(crate) force_spread_percent: f64,
    /// Stable, and not so with a force larger by the spread.
    pub(crate) within_spread: bool,
    /// Vibration forced by the teeth; null where it chatters or is not judged.
    pub(crate) vibration: Option<Vibration>,
    /// Places of the program that are like it.
    pub(crate) places: usize,
    /// Start of the range along the path.
    pub(crate) from_path_mm: f64,
    pub(crate) to_path_mm: f64,
}

/// The steady vibration of the tip about its mean place.
#[derive(Clone, Copy, Serialize, JsonSchema)]
pub(crate) struct Vibration {
    pub(crate) tooth_passing_hz: f64,
    /// Root of the mean square of the distance from the mean place.
    pub(crate) rms_um: f64,
    /// The strongest harmonic.
    pub(crate) strongest_hz: f64,
    /// The mode of the machine next to it.
    pub(crate) nearest_mode_hz: f64,
    /// Error of the wall over its height, positive: cut too deep; null where the cut makes no wall.
    pub(crate) wall_least_um: Option<f64>,
    pub(crate) wall_most_um: Option<f64>,
}

impl Vibration {
    fn of(found: &ForcedVibration) -> Self {
        Self {
            tooth_passing_hz: found.tooth_passing_hz,
            rms_um: 1e3 * found.root_mean_square_mm,
            strongest_hz: found.strongest_hz,
            nearest_mode_hz: found.nearest_mode_hz,
            wall_least_um: found.wall_mm.map(|[least, _]| 1e3 * least),
            wall_most_um: found.wall_mm.map(|[_, most]| 1e3 * most),
        }
    }
}

/// Lines in a row that chatter.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Stretch {
    pub(crate) first_line: usize,
    pub(crate) last_line: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) source: Option<String>,
    pub(crate) from_path_mm: f64,
    pub(crate) to_path_mm: f64,
    pub(crate) rpm: f64,
    pub(crate) depth_mm: f64,
    /// Does not chatter anywhere in the stretch at this speed.
    pub(crate) stable_depth_mm: f64,
    /// Speed at which the depths of the program, with its feeds per tooth, do not chatter: the nearest with stable speeds beside
    /// it; null: none of those from half to one and a half times in steps of 5 %, or not tried.
    pub(crate) stable_rpm: Option<f64>,
    /// A speed beside it, 5 % away, chatters; of such ones that with the largest limit.
    pub(crate) stable_speed_is_narrow: bool,
    /// Feed that keeps the feed per tooth at that speed; null where this changes along the stretch.
    pub(crate) stable_feed_mm_per_min: Option<f64>,
    /// Speeds are tried for the worst stretches.
    pub(crate) speeds_tried: bool,
    pub(crate) chatter_hz: f64,
    pub(crate) kind: Instability,
}

impl ChatterAnswer {
    pub(crate) fn new(
        found: &ProgramChatter,
        flat: Option<&FlatProgram>,
        program: &str,
        machine: &MachineSetup,
        damping: String,
        mut warnings: Vec<Warning>,
        setting: &ChatterSetting,
    ) -> Self {
        let source = |line: usize| flat?.place_of(line);
        let of_site = |judged: &JudgedSite| place(judged, source(judged.site.line));
        warnings.extend(limits(found, setting));
        Self {
            schema: 1,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            program: program.to_owned(),
            model: machine.run_inputs.model.clone(),
            material: (machine.cut.as_ref()).map_or_else(String::new, |cut| cut.material.clone()),
            damping,
            modes_up_to_hz: found.modes_up_to_hz(),
            places_in_cut: found.places,
            places_judged: found.sites.iter().filter(|site| site.is_judged()).count(),
            chatters: !found.stretches.is_empty(),
            nearest: found.nearest().map(of_site),
            stretches: (found.stretches.iter())
                .map(|s| Stretch {
                    first_line: s.lines[0],
                    last_line: s.lines[1],
                    source: source(s.lines[0]),
                    from_path_mm: s.path_mm[0],
                    to_path_mm: s.path_mm[1],
                    rpm: s.rpm,
                    depth_mm: s.depth_mm,
                    stable_depth_mm: s.stable_depth_mm,
                    stable_rpm: s.stable_speed.map(|stable| stable.rpm),
                    stable_speed_is_narrow: s.stable_speed.is_some_and(|stable| stable.is_narrow),
                    stable_feed_mm_per_min: (s.stable_speed)
                        .and_then(|stable| stable.feed_mm_per_min),
                    speeds_tried: s.speeds_tried,
                    chatter_hz: s.chatter_hz,
                    kind: s.kind,
                })
                .collect(),
            places: found.sites.iter().map(of_site).collect(),
            warnings,
        }
    }
}

fn place(judged: &JudgedSite, source: Option<String>) -> Place {
    let (site, station) = (&judged.site, &judged.site.station);
    let (verdict, reason) = match &judged.verdict {
        Verdict::Stable => ("stable", None),
        Verdict::Chatters => ("chatters", None),
        Verdict::NotJudged(why) => ("not judged", Some(why.clone())),
    };
    Place {
        line: site.line,
        source,
        path_mm: site.path_mm,
        position_mm: site.position_mm.into(),
        rpm: station.rpm,
        depth_mm: station.depth_mm,
        entry_deg: station.contact.map(|c| c.entry.to_degrees()),
        exit_deg: station.contact.map(|c| c.exit.to_degrees()),
        feed_per_tooth_mm: station.feed_per_tooth_mm,
        verdict,
        reason,
        limit_mm: judged.limit_mm,
        looked_up_to_mm: judged.looked_up_to_mm,
        chatter_hz: judged.chatter_hz,
        kind: judged.kind,
        first_hz: judged.first_hz,
        modes_up_to_hz: judged.modes_up_to_hz,
        force_spread_percent: 100.0 * judged.force_spread,
        within_spread: judged.is_within_spread(),
        vibration: judged.forced.as_ref().map(Vibration::of),
        places: judged.places,
        from_path_mm: judged.path_mm[0],
        to_path_mm: judged.path_mm[1],
    }
}
