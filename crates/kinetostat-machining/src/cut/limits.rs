//! What no cut should be: chips, edges and spindle against what they bear.

use std::f64::consts::TAU;

use kinetostat::number::{larger, short};
use kinetostat_cutting::{Contact, Edge, Engagement, Feed};

use crate::cut::drive::Drive;
use crate::cut::finding::{CutFindingKind, Findings};
use crate::cut::question::CutQuestion;
use crate::cut::station::CutStation;

/// A feed per tooth beyond this share of the diameter is no feed of milling.
const COARSE: f64 = 0.25;

impl CutQuestion {
    /// What no such cut should be.
    pub(crate) fn look_at(
        &self,
        (station, engagement): (&CutStation, &Engagement),
        (drive, feed): (&Drive<'_>, Feed),
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
        let coarse = COARSE * tool.tool.diameter_mm();
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
        if let Some(curve) = &self.spindle
            && let Some(found) = curve.exceeded_by(drive.rpm, 1e3 * station.torque_n_m)
        {
            let power = station.torque_n_m * drive.rpm * TAU / 60.0;
            findings.add(CutFindingKind::Spindle, line, power, || found.to_string());
        }
        let full = |c: &Contact| c.edge == Edge::End && c.exit - c.entry > 0.999 * TAU;
        if feed.down_mm > 0.0 && engagement.contacts.iter().any(full) {
            findings.add(CutFindingKind::Plunge, line, feed.down_mm, || {
                format!(
                    "the tool plunges with {} mm per tooth: its end must cut at the centre",
                    short(feed.down_mm)
                )
            });
        }
    }
}
