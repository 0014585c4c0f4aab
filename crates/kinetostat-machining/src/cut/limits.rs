//! Limits of chips, edges and spindle.

use std::f64::consts::TAU;

use kinetostat::number::{larger, short, smaller};
use kinetostat_cutting::{Contact, Edge, Engagement, Feed, Milling, Rotation};

use crate::cut::finding::{CutFindingKind, Findings};
use crate::cut::force::Drive;
use crate::cut::question::CutQuestion;
use crate::cut::station::CutStation;

/// A feed per tooth beyond this share of the diameter, or beyond this, mm, is no feed of milling: small high-feed cutters reach a
/// tenth, large ones (50 mm and more) 2.5 mm.
const COARSE: (f64, f64) = (0.1, 2.5);

/// Nor is one below this share, or below this, mm: an edge of sharp carbide is 2 to 5 um round, and rubs.
const FINE: (f64, f64) = (4e-4, 0.002);

/// Chips under the flat end that are thinner than this are beyond a law of which no range is known, mm.
const THINNEST_MM: f64 = 0.005;

/// Cuts deeper than this, in diameters, need a tool that is seldom made.
const DEEP: f64 = 8.0;

/// Warning about a cut deeper (mm) than the edges of nearly all tools of that diameter.
#[must_use]
pub fn deeper_than_edges(depth_mm: f64, diameter_mm: f64) -> Option<String> {
    let diameters = depth_mm / diameter_mm;
    (diameters > DEEP).then(|| {
        format!(
            "the cut is {} mm deep, {} times the tool's diameter: hardly a tool has such edges (--flute-length-mm, or flute_length_mm of the cutter, says how long they are)",
            short(depth_mm),
            short(diameters)
        )
    })
}

impl CutQuestion {
    /// Notes warnings about the cut at a station.
    pub(crate) fn look_at(
        &self,
        station: &CutStation,
        engagement: &Engagement,
        drive: &Drive<'_>,
        feed: Feed,
        line: usize,
        findings: &mut Findings,
    ) {
        let tool = drive.tool;
        let chip = feed.level_mm.hypot(feed.down_mm);
        if let Some(most) = tool.max_chip_mm
            && chip > most
        {
            findings.add(CutFindingKind::ThickChip, line, chip, || {
                format!(
                    "a feed of {} mm per tooth; the tool's maker allows {most} mm (max_chip_mm)",
                    short(chip)
                )
            });
        }
        let coarse = smaller(COARSE.0 * tool.tool.diameter_mm(), COARSE.1);
        if tool.max_chip_mm.is_none() && chip > coarse {
            findings.add(CutFindingKind::ThickChip, line, chip, || {
                format!(
                    "a feed of {} mm per tooth with a tool of {} mm: check feed, speed and number of teeth; the force is that of chips that no such tool cuts (max_chip_mm of the tool allows them)",
                    short(chip),
                    tool.tool.diameter_mm()
                )
            });
        }
        if let Some((least, most)) = tool.law.known_between_mm() {
            let thickest = station.chip_mm;
            let beyond = larger(thickest / most, least / thickest);
            if thickest > 0.0 && beyond > 1.0 {
                findings.add(CutFindingKind::OutsideTheLaw, line, beyond, || {
                    format!(
                        "chips of at most {} mm; the law of the material was measured from {least} to {most} mm: the force is a guess",
                        short(thickest)
                    )
                });
            }
        }
        if let Some(length) = tool.flute_length_mm
            && engagement.reach_mm() > length
        {
            let reach = engagement.reach_mm();
            findings.add(CutFindingKind::ShortEdges, line, reach, || {
                format!(
                    "material up to {} mm above the tip; edges or tool are {length} mm long there",
                    short(reach)
                )
            });
        }
        let deep = deeper_than_edges(engagement.reach_mm(), tool.tool.diameter_mm());
        if let (Some(text), None) = (deep, tool.flute_length_mm) {
            findings.add(CutFindingKind::DeepCut, line, engagement.reach_mm(), || {
                text
            });
        }
        if let Some(curve) = &self.spindle
            && let Some(found) = curve.exceeded_by(drive.rpm, 1e3 * station.torque_n_m)
        {
            let power = station.torque_n_m * drive.rpm * TAU / 60.0;
            findings.add(CutFindingKind::Spindle, line, power, || found.to_string());
        }
        let full = |c: &Contact| c.edge == Edge::End && c.exit - c.entry > 0.999 * TAU;
        if feed.down_mm > 0.0 && engagement.contacts.iter().any(full) {
            findings.add(CutFindingKind::Plunge, line, feed.down_mm, || {
                match feed.level_mm > 0.0 {
                    true => format!(
                        "the tool goes down at {:.2} degrees with its whole end in contact ({} mm per tooth under the end): its end must cut at the centre",
                        feed.down_mm.atan2(feed.level_mm).to_degrees(),
                        short(feed.down_mm)
                    ),
                    false => format!(
                        "the tool plunges with {} mm per tooth: its end must cut at the centre",
                        short(feed.down_mm)
                    ),
                }
            });
        }
        look_at_end(engagement, drive, feed, line, findings);
        if chip < larger(FINE.0 * tool.tool.diameter_mm(), FINE.1) {
            findings.add(CutFindingKind::ThinFeed, line, -chip, || {
                format!(
                    "a feed of {} mm per tooth with a tool of {} mm: no chip is so thin; F is read in mm/min (in mm/s it would be 60 times as much), so correct F, speed or number of teeth",
                    short(chip),
                    tool.tool.diameter_mm()
                )
            });
        }
        let helix_deg = tool.tool.helix().to_degrees();
        if self.rotation.is_none()
            && drive.rotation == Rotation::CounterClockwise
            && helix_deg > 0.0
        {
            findings.add(CutFindingKind::LeftHandTool, line, 0.0, || {
                format!(
                    "M4 with a helix of {helix_deg:.0} degrees that lifts the chip is the cut of a left-hand tool, and a right-hand one rubs with its back: write M3, or state rotation = \"counter_clockwise\" under [spindle]"
                )
            });
        }
    }
}

/// Force of a flat end whose chips are thinner than the law of force knows.
fn look_at_end(
    engagement: &Engagement,
    drive: &Drive<'_>,
    feed: Feed,
    line: usize,
    findings: &mut Findings,
) {
    let (tool, law) = (&drive.tool.tool, &*drive.tool.law);
    let thinnest_mm = law.known_between_mm().map_or(THINNEST_MM, |(from, _)| from);
    let has_end = engagement.contacts.iter().any(|c| c.edge == Edge::End);
    if !(has_end && feed.down_mm > 0.0 && feed.down_mm < thinnest_mm) {
        return;
    }
    let cut = Milling::new(tool, law, engagement, feed).turning(drive.rotation);
    let [end_n, all_n] = [cut.mean_of_end(), cut.mean()].map(|force| force.force_n.z.abs());
    findings.add(CutFindingKind::EndBeyondTheLaw, line, end_n, || {
        format!(
            "the flat end takes {} mm per tooth, and the law of the material is known from {} mm on: {end_n:.0} of {all_n:.0} N along the tool are edge forces of the end, a guess. An end with relief bears less, down to {:.0} N in all",
            short(feed.down_mm),
            short(thinnest_mm),
            (all_n - end_n).abs()
        )
    });
}
