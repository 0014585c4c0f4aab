//! The cut: which part of the tool is in the material, how fast it goes, and what the spindle gives.

use std::f64::consts::{PI, TAU};

use kinetostat::number::smaller;
use kinetostat_cutting::{Contact, Engagement, Feed, Rotation, Shape, Side, SpindleCurve, Tool};
use kinetostat_diagnostic::ErrorCode;

use crate::force::arguments::{CutArgs, PartWord, SpindleArgs};
use crate::force::refusal::{refused, within};
use crate::ui::failure::{Answer, Failing};

/// Diameters of the tool: no cut is deeper.
const DEEPEST: f64 = 50.0;

/// Side of the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Side(Side),
    /// On both sides: the cut is as wide as the tool.
    Slot,
}

/// Milling mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Climb,
    Conventional,
    Slot,
}

#[derive(Clone, Debug)]
pub(crate) struct Cut {
    pub(crate) width_mm: f64,
    pub(crate) depth_mm: f64,
    pub(crate) part: Part,
    pub(crate) way: Way,
    pub(crate) rotation: Rotation,
    pub(crate) engagement: Engagement,
    pub(crate) feed: Feed,
    pub(crate) rpm: Option<f64>,
    /// Diameter at the widest place in the cut, mm.
    pub(crate) widest_mm: f64,
    pub(crate) spindle: Option<SpindleCurve>,
}

impl Cut {
    pub(crate) fn feed_mm_per_min(&self, tool: &Tool) -> Option<f64> {
        let rpm = self.rpm?;
        Some(self.feed.level_mm * tool.teeth() as f64 * rpm)
    }

    /// Speed of the edge at its widest place, m/min.
    pub(crate) fn speed_m_per_min(&self) -> Option<f64> {
        Some(1e-3 * PI * self.widest_mm * self.rpm?)
    }

    /// Power of a torque, W.
    pub(crate) fn power_w(&self, torque_n_mm: f64) -> Option<f64> {
        Some(1e-3 * torque_n_mm * TAU * self.rpm? / 60.0)
    }
}

/// A straight cut without its feed.
#[derive(Clone, Debug)]
pub(crate) struct Straight {
    pub(crate) width_mm: f64,
    pub(crate) depth_mm: f64,
    pub(crate) part: Part,
    pub(crate) way: Way,
    pub(crate) rotation: Rotation,
    pub(crate) engagement: Engagement,
    /// Diameter at the widest place in the cut, mm.
    widest_mm: f64,
}

/// Returns the engagement of the tool by width, depth and side.
pub(crate) fn straight(tool: &Tool, args: &CutArgs) -> Answer<Straight> {
    let given = |option: &str, value: Option<f64>, what: &str| -> Answer<f64> {
        let value = value.ok_or_else(|| {
            ErrorCode::Missing.failure(format!("the cut needs {option}: {what}, in mm"))
        })?;
        match value == 0.0 {
            true => Err(ErrorCode::Value.failure(format!("{option} 0 cuts nothing; give {what}"))),
            false => Ok(value),
        }
    };
    let width_mm = given("--width-mm AE", args.width_mm, "its width across the feed")?;
    let depth_mm = given("--depth-mm AP", args.depth_mm, "its depth along the tool")?;
    let deepest = smaller(1e4, DEEPEST * tool.diameter_mm());
    within("depth of cut", depth_mm, 1e-6..=deepest, "mm")?;
    let widest_mm = 2.0 * tool.radius_at_mm(depth_mm);
    // Inserts that lean outward are widest at full depth; a ball and a corner count as what they are above.
    let across_mm = match tool.shape() {
        Shape::Face { .. } => widest_mm,
        _ => tool.diameter_mm(),
    };
    if width_mm > across_mm * (1.0 + 1e-9) {
        return Err(ErrorCode::Value.failure(format!(
                "--width-mm: width of cut of {width_mm} mm; expected at most the {across_mm} mm of the tool, which is a slot"
            ),
        ));
    }
    within("width of cut", width_mm, 1e-6..=2.0 * across_mm, "mm")?;
    let rotation = match args.counter_clockwise {
        true => Rotation::CounterClockwise,
        false => Rotation::Clockwise,
    };
    let (part, way) = match width_mm >= across_mm * (1.0 - 1e-9) {
        true => (Part::Slot, Way::Slot),
        false => side(args, rotation)?,
    };
    let (width, seen_as) = match part {
        Part::Side(side) => (width_mm, side),
        Part::Slot => (across_mm, Side::Left),
    };
    let engagement = Engagement::straight(0.5 * across_mm, width, depth_mm, seen_as)
        .map_err(|error| refused(&error))?;
    Ok(Straight {
        width_mm: width,
        depth_mm,
        part,
        way,
        rotation,
        engagement,
        widest_mm,
    })
}

pub(crate) fn cut_of(tool: &Tool, args: &CutArgs, spindle: &SpindleArgs) -> Answer<Cut> {
    let of = straight(tool, args)?;
    let rpm = args
        .rpm
        .map(|rpm| within("speed of the spindle", rpm, 1e-3..=1e6, "turns per minute"))
        .transpose()?;
    let spindle = curve(spindle)?;
    if spindle.is_some() && rpm.is_none() {
        return Err(ErrorCode::Missing.failure(
            "what the spindle gives depends on its speed: --spindle-power-w needs --rpm",
        ));
    }
    let feed = feed(tool, args, rpm)?;
    if feed.down_mm != 0.0 && of.part != Part::Slot {
        return Err(ErrorCode::Unused.failure("--down-feed-per-tooth-mm is for slots: at a side cut it depends on what the floor looks like. Make --width-mm the diameter",
        ));
    }
    let mut engagement = of.engagement;
    if feed.down_mm > 0.0 && tool.end_radius_mm() > 0.0 {
        // The floor of a ramp falls ahead of the tool and behind it: the whole end cuts.
        let end = Contact::end(0.0, tool.end_radius_mm(), 0.0, TAU);
        engagement.contacts.push(end);
    }
    Ok(Cut {
        width_mm: of.width_mm,
        depth_mm: of.depth_mm,
        part: of.part,
        way: of.way,
        rotation: of.rotation,
        engagement,
        feed,
        rpm,
        widest_mm: of.widest_mm,
        spindle,
    })
}

/// Returns the side of the part, from the side itself or from the milling mode.
fn side(args: &CutArgs, rotation: Rotation) -> Answer<(Part, Way)> {
    let climb_at = match rotation {
        Rotation::Clockwise => Side::Right,
        Rotation::CounterClockwise => Side::Left,
    };
    let other = match climb_at {
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    };
    let side = match (args.part, args.climb, args.conventional) {
        (Some(PartWord::Left), ..) => Side::Left,
        (Some(PartWord::Right), ..) => Side::Right,
        (None, true, _) => climb_at,
        (None, false, true) => other,
        (None, false, false) => {
            return Err(ErrorCode::Missing.failure("on which side is the part? Give --part left or --part right as seen along the feed, or --climb or --conventional (or make --width-mm the diameter: a slot)",
            ));
        }
    };
    let way = match side == climb_at {
        true => Way::Climb,
        false => Way::Conventional,
    };
    Ok((Part::Side(side), way))
}

fn feed(tool: &Tool, args: &CutArgs, rpm: Option<f64>) -> Answer<Feed> {
    let per_tooth = match (args.feed_per_tooth_mm, args.feed_mm_per_min) {
        (Some(per_tooth), _) => per_tooth,
        (None, Some(per_min)) => {
            let rpm = rpm.ok_or_else(|| {
                ErrorCode::Missing.failure("--feed-mm-per-min needs --rpm: how far the tool goes from tooth to tooth depends on both",
                )
            })?;
            let most = 10.0 * tool.teeth() as f64 * rpm;
            within("feed", per_min, 0.0..=most, "mm/min")? / (tool.teeth() as f64 * rpm)
        }
        (None, None) => {
            return Err(ErrorCode::Missing
                .failure("how fast? Give --feed-per-tooth-mm, or --feed-mm-per-min with --rpm"));
        }
    };
    if per_tooth == 0.0 {
        return Err(ErrorCode::Value.failure("a feed of 0 cuts nothing; give one above it"));
    }
    let down = args.down_feed_per_tooth_mm.unwrap_or(0.0);
    Feed::ramp(per_tooth, down).map_err(|error| refused(&error))
}

/// Torque curve of the spindle; none without its data.
pub(crate) fn curve(args: &SpindleArgs) -> Answer<Option<SpindleCurve>> {
    let (Some(power), Some(base), Some(most)) = (
        args.spindle_power_w,
        args.spindle_base_rpm,
        args.spindle_most_rpm,
    ) else {
        return Ok(None);
    };
    let curve = SpindleCurve::rated(power, base, most);
    curve.map(Some).map_err(|error| refused(&error))
}
