//! Expansion of a drilling cycle call to blocks, and the patterns of holes under MCALL: HOLES1 (a row) and HOLES2 (a circle).

use crate::siemens::block::{Argument, Item, What};
use crate::siemens::flat::drilling::{Deep, Drilling};
use crate::siemens::flat::runner::{Fault, Runner};
use crate::siemens::table::KEPT;
use crate::siemens::values::whole;
use crate::siemens::writing::place::number_text;

/// The cycle of a call.
pub(super) fn drilling_of(runner: &Runner<'_>, item: &Item) -> Result<Drilling, Fault> {
    let What::Call(arguments) = &item.what else {
        return Err(runner.fault(&item.span, "the cycle has no arguments", "state them"));
    };
    let name = runner.file().part(&item.name).to_ascii_uppercase();
    let fault = |reason: &str| runner.fault(&item.span, reason, "mend the call of the cycle");
    let value = |index: usize| -> Result<Option<f64>, Fault> {
        match arguments.get(index) {
            Some(Argument { span, value }) if !span.is_empty() => match value {
                Some(value) => runner.number(value).map(Some),
                None => Err(fault("an argument is no number")),
            },
            _ => Ok(None),
        }
    };
    let or_zero = |index: usize| Ok::<f64, Fault>(value(index)?.unwrap_or(0.0));
    let need = |index: usize, what: &str| value(index)?.ok_or_else(|| fault(what));
    let retract = need(0, "where it withdraws to (RTP) is not stated")?;
    let surface = need(1, "the reference plane (RFP) is not stated")?;
    let safety = or_zero(2)?.abs();
    let relative = or_zero(4)?.abs();
    let depth = match (relative > 0.0, value(3)?) {
        (true, _) if retract == surface => {
            return Err(fault(
                "in which direction DPR counts is not known: RTP is RFP",
            ));
        }
        (true, _) => surface - (retract - surface).signum() * relative,
        (false, Some(depth)) => depth,
        (false, None) => return Err(fault("no depth is stated (DP or DPR)")),
    };
    let way = (surface - depth).signum();
    if surface == depth || retract != surface && (retract - surface).signum() != way {
        return Err(fault(
            "the hole does not go from the reference plane away from where it withdraws to",
        ));
    }
    let kept = KEPT.iter().find(|own| own.as_bytes() == name);
    let kept = kept.map(|own| runner.call_text(own, arguments));
    let known = match name.as_slice() {
        _ if kept.is_some() => arguments.len(),
        b"CYCLE81" => 5,
        b"CYCLE82" => 6,
        _ => 17,
    };
    for index in known..arguments.len() {
        if or_zero(index)? != 0.0 {
            return Err(fault(
                "an argument behind those that are followed is not zero",
            ));
        }
    }
    let mut drilling = Drilling {
        retract,
        begin: surface + way * safety,
        surface,
        depth,
        dwell: match name.as_slice() {
            b"CYCLE82" => or_zero(5)?,
            _ => 0.0,
        },
        exact: name == b"CYCLE81",
        deep: None,
        kept,
    };
    if name == b"CYCLE83" {
        let by = or_zero(6)?.abs();
        let first = match (by > 0.0, value(5)?) {
            (true, _) => surface - way * by,
            (false, Some(first)) => first,
            (false, None) => return Err(fault("no first depth is stated (FDEP or FDPR)")),
        };
        if (surface - first) * way <= 0.0 {
            return Err(fault("the first depth is not below the reference plane"));
        }
        let first = match (first - depth) * way < 0.0 {
            true => depth,
            false => first,
        };
        let feed_share = value(10)?.unwrap_or(1.0);
        if !(0.001..=1.0).contains(&feed_share) {
            return Err(fault(
                "the share of the first feed (FRF) is not from 0.001 to 1",
            ));
        }
        let (between, last) = (or_zero(8)?, or_zero(15)?);
        let back = or_zero(14)?;
        drilling.dwell = match last == 0.0 {
            true => between,
            false => last,
        };
        if or_zero(12)? != 0.0 && or_zero(12)? != 3.0 {
            return Err(fault(
                "the axis of the tool (_AXN) is another one than across the plane",
            ));
        }
        drilling.deep = Some(Deep {
            first,
            shorter: or_zero(7)?,
            least: or_zero(13)?,
            dwell: between,
            dwell_above: or_zero(9)?,
            feed_share,
            withdraws: or_zero(11)? != 0.0,
            back: match back > 0.0 {
                true => back,
                false => BACK_MM / runner.modes.unit_mm(),
            },
            ahead: or_zero(16)?,
        });
    }
    Ok(drilling)
}

/// Chips are broken: on its way back in the hole the drill cuts nothing, at feed as by a rapid.
const BACK: &str = "CYCLE83 breaks chips (VARI=0): its way back in the hole is written by G1 at the feed, as the cycle does as far as is known here (the manual was not at hand). Of a control that goes back by G0 the way is the same and the time shorter; there the load is taken where nothing is cut";

/// Steps that stay as long as the first one.
const EVEN: &str = "CYCLE83 without DAM: all steps are taken as long as the first, which is not certain here (the manual was not at hand). Compare the depths with those of the control, or state DAM and _MDEP";

/// Retraction of CYCLE83 within a hole where _VRT is not stated, mm.
const BACK_MM: f64 = 1.0;

/// Stop distance before the drilled depth, in units of the program: where _DIS1 is not stated, 0.6 mm down to 30 mm, then a fiftieth of the depth, at
/// most 7 mm.
fn ahead_of(deep: &Deep, drilled: f64, unit_mm: f64) -> f64 {
    let drilled_mm = drilled * unit_mm;
    match drilled_mm <= 30.0 {
        _ if deep.ahead > 0.0 => deep.ahead,
        true => 0.6 / unit_mm,
        false => (drilled_mm / 50.0).min(7.0) / unit_mm,
    }
}

fn dwell(time: f64) -> Option<String> {
    match time {
        _ if time > 0.0 => Some(format!("G4 F{}", number_text(time))),
        _ if time < 0.0 => Some(format!("G4 S{}", number_text(-time))),
        _ => None,
    }
}

impl Runner<'_> {
    /// A call of a cycle with numbers in place of expressions.
    fn call_text(&self, name: &str, arguments: &[Argument]) -> String {
        let text = |argument: &Argument| {
            let known = argument
                .value
                .as_ref()
                .and_then(|value| self.number(value).ok());
            match known {
                Some(number) => number_text(number),
                None => String::from_utf8_lossy(self.file().part(&argument.span)).into_owned(),
            }
        };
        let arguments: Vec<String> = arguments.iter().map(text).collect();
        format!("{name}({})", arguments.join(","))
    }

    /// Notes what is in doubt of a cycle where the tool is.
    pub(super) fn doubt(&mut self, drilling: &Drilling) {
        let Some(deep) = &drilling.deep else {
            return;
        };
        let unit = self.levels.last().map_or(0, |level| level.unit);
        let place = (unit, self.file().line_of(self.span().start));
        let has_steps = deep.first != drilling.depth;
        let doubts = [(BACK, !deep.withdraws), (EVEN, deep.shorter == 0.0)];
        for (what, _) in doubts.into_iter().filter(|(_, is)| *is && has_steps) {
            let lines = self.doubts.0.entry((what, place.0)).or_default();
            // A loop drills by one line many times.
            if lines.last() != Some(&place.1) {
                lines.push(place.1);
            }
        }
    }

    /// Writes the blocks of a cycle where the tool is.
    pub(super) fn drill_here(&mut self, drilling: &Drilling) -> Result<(), Fault> {
        let axis = self.modes.normal();
        let to = |at: f64| format!("{axis}=AC({})", number_text(at));
        let mut blocks = vec![format!("G0 {}", to(drilling.begin))];
        self.doubt(drilling);
        match (&drilling.deep, &drilling.kept) {
            (_, Some(call)) => blocks.push(call.clone()),
            (None, _) => {
                let exact = if drilling.exact { "G9 " } else { "" };
                blocks.push(format!("G1 {exact}{}", to(drilling.depth)));
                blocks.extend(dwell(drilling.dwell));
            }
            (Some(deep), _) => {
                let depths = drilling.depths(deep).ok_or_else(|| {
                    self.fault(
                        &self.span(),
                        "the hole would have more than 1000 steps",
                        "state a least step (_MDEP)",
                    )
                })?;
                let changes = deep.feed_share != 1.0;
                let feed = match (changes, self.feed) {
                    (false, _) => None,
                    (true, Some(feed)) => Some(feed),
                    (true, None) => {
                        return Err(self.fault(
                            &self.span(),
                            "the feed of which FRF is a share is not known",
                            "state F before",
                        ));
                    }
                };
                let way = (drilling.surface - drilling.depth).signum();
                for (index, depth) in depths.iter().enumerate() {
                    // The feed of the program is stated again in the first block by G1 behind the first step.
                    let further =
                        feed.map_or(String::new(), |feed| format!(" F{}", number_text(feed)));
                    let stated = match (index, feed) {
                        (0, Some(feed)) => format!(" F{}", number_text(feed * deep.feed_share)),
                        (1, _) if deep.withdraws => further.clone(),
                        _ => String::new(),
                    };
                    blocks.push(format!("G1 {}{stated}", to(*depth)));
                    if index + 1 == depths.len() {
                        blocks.extend(dwell(drilling.dwell));
                        break;
                    }
                    blocks.extend(dwell(deep.dwell));
                    if deep.withdraws {
                        blocks.push(format!("G0 {}", to(drilling.begin)));
                        blocks.extend(dwell(deep.dwell_above));
                        let drilled = (drilling.surface - depth).abs();
                        let ahead = ahead_of(deep, drilled, self.modes.unit_mm());
                        blocks.push(format!("G0 {}", to(depth + way * ahead)));
                    } else {
                        let stated = if index == 0 { further.as_str() } else { "" };
                        blocks.push(format!("G1 {}{stated}", to(depth + way * deep.back)));
                    }
                }
                if let (1, Some(feed)) = (depths.len(), feed) {
                    blocks.push(format!("F{}", number_text(feed)));
                }
            }
        }
        blocks.push(format!("G0 {}", to(drilling.retract)));
        if let Some(code) = self.modes.motion().filter(|code| *code != "G0") {
            blocks.push(code.to_owned());
        }
        for block in blocks {
            self.write_line(block.as_bytes());
        }
        Ok(())
    }
}

// HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM): a row through (SPCA, SPCO) at the angle STA1 to the first axis of the plane, its first hole FDIS from
// there, its holes DBH apart. HOLES2(CPA, CPO, RAD, STA1, INDA, NUM): a circle about (CPA, CPO), its first hole at the angle STA1, the
// others INDA apart; with INDA = 0 they share the circle evenly. Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Cycles, "Row
// of holes - HOLES1", "Circle of holes - HOLES2". From which end a row is drilled the control chooses: the holes are the same.

/// Limit of the holes of a pattern.
const MOST_HOLES: u32 = 1000;

impl Runner<'_> {
    /// Drills at each place of a pattern by the cycle in force.
    pub(super) fn holes(&mut self, item: &Item) -> Result<(), Fault> {
        let fault = |reason: &str| self.fault(&item.span, reason, "mend the call of the pattern");
        let Some(drilling) = self.drilling.clone() else {
            return Err(fault("no cycle is in force (MCALL)"));
        };
        let What::Call(arguments) = &item.what else {
            return Err(fault("the pattern has no arguments"));
        };
        let mut numbers = [0.0; 6];
        for (number, argument) in numbers.iter_mut().zip(arguments) {
            if let Some(value) = &argument.value {
                *number = self.number(value)?;
            }
        }
        if arguments.len() > numbers.len() {
            return Err(fault("it has more than six arguments"));
        }
        let [first, second, third, fourth, fifth, count] = numbers;
        let Some(count) = whole(count).filter(|count| (1..=MOST_HOLES).contains(count)) else {
            return Err(fault("the number of its holes (NUM) is not from 1 to 1000"));
        };
        let is_row = self.file().part(&item.name).eq_ignore_ascii_case(b"HOLES1");
        let place = |hole: u32| {
            let hole = f64::from(hole);
            let (radius, angle) = match is_row {
                true => (fourth + hole * fifth, third),
                false if fifth == 0.0 => (third, fourth + hole * 360.0 / f64::from(count)),
                false => (third, fourth + hole * fifth),
            };
            let (sine, cosine) = angle.to_radians().sin_cos();
            [first + radius * cosine, second + radius * sine]
        };
        let axes = match self.modes.normal() {
            'X' => ['Y', 'Z'],
            'Y' => ['Z', 'X'],
            _ => ['X', 'Y'],
        };
        for hole in 0..count {
            let words = axes.iter().zip(place(hole));
            let words = words.map(|(axis, at)| format!(" {axis}=AC({})", number_text(at)));
            self.write_line(format!("G0{}", words.collect::<String>()).as_bytes());
            self.drill_here(&drilling)?;
        }
        Ok(())
    }
}
