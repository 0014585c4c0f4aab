//! Chatter stability of the cut at one place.

use kinetostat::Wrench;
use kinetostat_chatter::{Arc, Coefficients, FeedFrame, MillingCut, Regeneration, SpeedStability};
use kinetostat_dynamics::Held;
use kinetostat_machining::{LoadAlongPath, posture_at};
use nalgebra::Vector3;

use crate::vibration::cut::{MachineCut, MachineCutError};
use crate::vibration::machine::VibratingMachine;
use crate::vibration::program::forced::ForcedVibration;
use crate::vibration::program::judged::{JudgedSite, Verdict};
use crate::vibration::program::question::{ChatterQuestion, ProgramChatterError};
use crate::vibration::program::site::{CutSite, SiteGroup};

/// Depths are looked at up to so many times that of the program first.
const FIRST_DEPTH: f64 = 0.125;

/// Multiples of the program's depth searched next, one after the other until there is a limit: far beyond their limits
/// cuts grow by so much in one period that nothing can be said in numbers.
const DEPTHS: [f64; 3] = [0.5, 1.0, 3.0];

/// The cut at a place with the machine in its posture.
pub(crate) struct SiteCut {
    pub regeneration: Regeneration,
    machine: VibratingMachine,
}

/// Stability at a spindle speed up to a depth, m, or up to the first limit below it; where the cut is stable there, up to a
/// depth a few times larger, if `beyond`. Islands above the limit are not looked for: the tool passes the limit on its way there.
pub(crate) fn limit_at(
    regeneration: &Regeneration,
    rpm: f64,
    depth: f64,
    beyond: bool,
) -> kinetostat_chatter::Result<SpeedStability> {
    let mut found = regeneration.first_limit(None, rpm, FIRST_DEPTH * depth)?;
    for share in DEPTHS {
        let is_deeper = share > 1.0;
        if found.limit().is_some() || (is_deeper && !beyond) {
            break;
        }
        match regeneration.first_limit(Some(&found), rpm, share * depth) {
            Ok(deeper) => found = deeper,
            // A limit beyond the depth of the program need not be known.
            Err(_) if is_deeper => break,
            Err(error) => return Err(error),
        }
    }
    Ok(found)
}

impl ChatterQuestion<'_> {
    /// Judges a group of places by the worst of those that stand for it.
    pub(crate) fn judge(
        &self,
        load: &LoadAlongPath<'_>,
        group: &SiteGroup<'_>,
        wider: f64,
    ) -> Result<JudgedSite, ProgramChatterError> {
        let (deepest, others) = group.judged(wider);
        let mut worst = self.judge_site(load, deepest, group)?;
        for site in others {
            let found = self.judge_site(load, site, group)?;
            if found.is_worse_than(&worst) {
                worst = found;
            }
        }
        Ok(worst)
    }

    /// Judges one place of a group.
    fn judge_site(
        &self,
        load: &LoadAlongPath<'_>,
        site: &CutSite,
        group: &SiteGroup<'_>,
    ) -> Result<JudgedSite, ProgramChatterError> {
        let Some(contact) = site.station.contact else {
            let why = "the side of the tool has no arc of contact of its own, or the spindle turns to the left";
            return Ok(JudgedSite::not_judged(site, group, why));
        };
        if contact.exit - contact.entry <= 0.0 {
            let why = "the arc of contact has no length";
            return Ok(JudgedSite::not_judged(site, group, why));
        }
        let SiteCut {
            regeneration,
            machine,
        } = match self.site_cut(load, site)? {
            Ok(cut) => cut,
            Err(why) => return Ok(JudgedSite::not_judged(site, group, why)),
        };
        let depth = 1e-3 * site.station.depth_mm;
        let found = limit_at(&regeneration, site.station.rpm, depth, true);
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                return Ok(JudgedSite {
                    is_open: true,
                    ..JudgedSite::not_judged(site, group, error.to_string())
                });
            }
        };
        let limit = found.limit().copied();
        let lost_coupling = machine
            .lost_coupling(self.damping, found.modes_up_to_hz)
            .map_err(|error| Self::of_machine(site, error))?;
        let modes = regeneration.response().modes();
        let chatters = limit.is_some_and(|crossing| crossing.depth <= depth);
        let forced =
            match chatters {
                true => None,
                false => ForcedVibration::of(&regeneration, self.tool_of(site)?, site).map_err(
                    |error| ProgramChatterError::Cut {
                        line: site.line,
                        error,
                    },
                )?,
            };
        Ok(JudgedSite {
            site: *site,
            verdict: match chatters {
                true => Verdict::Chatters,
                false => Verdict::Stable,
            },
            limit_mm: limit.map(|crossing| 1e3 * crossing.depth),
            looked_up_to_mm: 1e3 * found.up_to,
            chatter_hz: limit.map(|crossing| crossing.frequency_hz),
            kind: limit.map(|crossing| crossing.kind),
            first_hz: modes
                .iter()
                .map(kinetostat_chatter::Mode::frequency_hz)
                .reduce(|a, b| if b < a { b } else { a }),
            forced,
            modes_up_to_hz: Some(found.modes_up_to_hz),
            left_out: found.left_out,
            force_spread: self.tool_of(site)?.spread,
            lost_coupling,
            is_open: false,
            cluster: 0,
            places: group.count(),
            path_mm: group.path_mm(),
        })
    }

    /// The cut there with the machine in its posture; in the inner result why nothing can be said of it.
    pub(crate) fn site_cut(
        &self,
        load: &LoadAlongPath<'_>,
        site: &CutSite,
    ) -> Result<Result<SiteCut, String>, ProgramChatterError> {
        let (line, task) = (site.line, self.task);
        let motion = &task.path().moves[site.move_index];
        let placement = task.placement.on(motion, site.station.share);
        let orientation = placement.orientation_on(motion, site.station.share);
        let pose = placement.pose(&site.position_mm, orientation);
        let frame = FeedFrame::new(
            placement.to_base_axes(&site.direction),
            placement.to_base_axes(&Vector3::z()),
        );
        let Ok(frame) = frame else {
            return Ok(Err("the tool goes along its axis".to_owned()));
        };
        let mechanism = load
            .tool_of(site.move_index)
            .map_or(task.mechanism, |tool| tool.mechanism);
        // A dead moment has no potential, and its part in the modes is that of newton metres beside the stiffness of the joints.
        let force = load
            .wrench(&placement, site.move_index, site.station.share)
            .force();
        let wrench = Wrench::new(force, Vector3::zeros());
        let of_machine = |error| Self::of_machine(site, error);
        let machine = posture_at(mechanism, &pose)
            .map_err(Into::into)
            .and_then(|posture| VibratingMachine::at(&posture, &wrench, &Held::nothing()))
            .map_err(of_machine)?;
        let cut = self.milling(site)?;
        let of_cut = MachineCut {
            machine: &machine,
            damping: self.damping,
            frame,
            cut,
            swinging: self.swinging,
        };
        match of_cut.regeneration() {
            Ok(regeneration) => Ok(Ok(SiteCut {
                regeneration,
                machine,
            })),
            Err(MachineCutError::NoVibration(why)) => Ok(Err(why)),
            Err(MachineCutError::Machine(error)) => Err(of_machine(error)),
            Err(MachineCutError::Cut(error)) => Err(ProgramChatterError::Cut { line, error }),
        }
    }

    fn of_machine(site: &CutSite, error: kinetostat_dynamics::Error) -> ProgramChatterError {
        ProgramChatterError::Machine {
            line: site.line,
            error,
        }
    }

    /// The cut itself: its arc, the tool's edges, and the law of force at the mean thickness of its chips.
    fn milling(&self, site: &CutSite) -> Result<MillingCut, ProgramChatterError> {
        let line = site.line;
        let of_cut = |error| ProgramChatterError::Cut { line, error };
        let contact = site.station.contact.map(|c| [c.entry, c.exit]);
        let [entry, exit] = contact.unwrap_or([0.0, 0.0]);
        let arc = Arc::new(entry, exit).map_err(of_cut)?;
        let tool = self.tool_of(site)?;
        // A tooth that moves backwards over the arc gets the mean chip thickness of the arc.
        let mean_mm = site.station.feed_per_tooth_mm * arc.mean_sine().abs();
        let thinnest_mm = 1e-3 * site.station.feed_per_tooth_mm;
        let chip_mm = if mean_mm > thinnest_mm {
            mean_mm
        } else {
            thinnest_mm
        };
        let law = Coefficients::linearised(&*tool.law, 1e-3 * chip_mm).map_err(of_cut)?;
        MillingCut::of_tool(&tool.tool, arc, law.coefficients).map_err(of_cut)
    }
}
