//! Rounded corners (RND) and chamfers (CHF): between which lines they are, and what they become where the program is written flat.
//!
//! The number of CHF is the "chamfer side length" of HEIDENHAIN's manuals (TNC 320, 2013, and TNC 620, 2022, table "Overview of path
//! functions"): so much it takes of each line.

use std::ops::Range;

use nalgebra::Vector3;

use crate::corner::{Beside, Corner, Cut, rounding};
use crate::heidenhain::arcs::XY;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::ends::Went;
use crate::heidenhain::reading::walker::{AS_ARC, AS_LINE, Line, Pending, Reader, Rounded};
use crate::heidenhain::words::Word;

/// An arc that turns by more has no corner of its own, rad.
const MOST_OF_A_TURN: f64 = 0.999 * std::f64::consts::TAU;

/// Heights nearer than this are one, mm.
const SAME_MM: f64 = 1e-9;

impl Reader<'_> {
    /// A block RND or CHF: what it rounds or breaks shows behind the next block.
    pub(crate) fn note_corner(&mut self, block: &Block, words: &[Word], span: &Range<usize>) {
        self.settle_corner(None);
        let word = words[1..].iter().find(|word| word.is("R"));
        let is_chamfer = words[0].is("CHF");
        let size = match is_chamfer {
            true => words[0].value(),
            false => words[0].value().or(word.and_then(Word::value)),
        };
        let feed = words.iter().find(|word| word.is("F"));
        let known = |word: &Word| {
            (word.is("F") || !is_chamfer && (word.is("R") || word.is("RND")))
                && word.value().is_some()
        };
        let cut = match (size.map(|size| size * self.unit_mm), is_chamfer) {
            (Some(_), _) if !words[1..].iter().all(known) => {
                Err("another word stands beside its size and its feed".to_owned())
            }
            (Some(size), true) => Ok(Cut::Sides(size)),
            (Some(size), false) => Ok(Cut::Rounded(size)),
            (None, true) => Err("its length is not stated as a number".to_owned()),
            (None, false) => Err("its radius is not stated as a number".to_owned()),
        };
        self.corner = Some(Pending {
            line: self.line.take(),
            block: block.clone(),
            span: span.clone(),
            cut,
            feed: feed.and_then(Word::value),
            remedy: match is_chamfer {
                true => AS_LINE,
                false => AS_ARC,
            },
        });
    }

    /// A block that was followed from the place in the state to another: the line before a corner, or the one behind; or an arc
    /// about a pole.
    pub(crate) fn line_went(
        &mut self,
        block: &Block,
        words: &[Word],
        went: &Went,
        to: Vector3<f64>,
        rapid: bool,
    ) {
        let plane = went.plane;
        let arc = went.arc.as_ref().map(|arc| Beside {
            centre: arc.centre,
            angle: arc.angle,
        });
        if words[0].is("LP") && !self.found.corners.is_empty() {
            let polar = (block.clone(), to.xy(), self.unit_mm);
            match plane == XY {
                true => self.found.polar.push(polar),
                false => {
                    let why = "a polar block behind a corner is in another plane than X and Y";
                    self.found
                        .corners
                        .push(Err((block.text.clone(), why.to_owned(), AS_ARC)));
                }
            }
        }
        let [Some(x), Some(y), Some(z)] = self.state.place else {
            return;
        };
        let known = match arc {
            _ if self.state.plane != XY || arc.is_some() && plane != XY => false,
            None => words[0].is("L") || words[0].is("LP"),
            // More than a turn has no end of its own.
            Some(arc) => {
                (words[0].is("C") || words[0].is("CP")) && arc.angle.abs() < MOST_OF_A_TURN
            }
        };
        if !known {
            return;
        }
        self.line = Some(Line {
            block: block.clone(),
            from: Vector3::new(x, y, z),
            to,
            arc,
            rapid,
            unit_mm: self.unit_mm,
            feed: self.state.feed,
        });
    }

    /// Resolves a pending corner at its second line; `None` if no line follows.
    pub(crate) fn settle_corner(&mut self, behind: Option<&Line>) {
        let Some(pending) = self.corner.take() else {
            return;
        };
        let span = pending.span.clone();
        match rounded(&pending, behind) {
            Ok(rounded) => {
                if let Some(line) = &mut self.line {
                    let [_, second] = rounded.corner.ends;
                    line.arc = line.leg().rest_from(second).arc;
                    line.from = Vector3::new(second.x, second.y, line.from.z);
                }
                self.found.corners.push(Ok(rounded));
            }
            Err(why) => self.found.corners.push(Err((span, why, pending.remedy))),
        }
    }
}

fn rounded(pending: &Pending, behind: Option<&Line>) -> Result<Rounded, String> {
    let cut = pending.cut.clone()?;
    let before = pending.line.as_ref().ok_or_else(|| {
        "the block before it is no straight line, and no arc about a pole, whose start and end are known".to_owned()
    })?;
    let behind = behind.ok_or_else(|| {
        "the block behind it is no straight line, and no arc about a pole, whose end is known"
            .to_owned()
    })?;
    let heights = [before.from.z, before.to.z, behind.to.z];
    if heights.iter().any(|z| (z - heights[0]).abs() > SAME_MM) {
        return Err("the tool rises or sinks along a line at the corner".to_owned());
    }
    if before.rapid || behind.rapid {
        return Err("a line at the corner is in rapid traverse (FMAX)".to_owned());
    }
    if pending.feed.is_some() && before.feed.is_none() {
        return Err("the feed behind it is not known as a number".to_owned());
    }
    let places = [before.from, before.to, behind.to].map(|place| place.xy());
    let arcs = [before.arc, behind.arc].iter().flatten().count();
    let corner = match (cut, arcs) {
        (_, 0) => Corner::cut(places, cut)?,
        (Cut::Rounded(radius), 1) => rounding([before.leg(), behind.leg()], radius)?,
        (Cut::Rounded(_), _) => return Err("it is between two arcs".to_owned()),
        _ => return Err("a chamfer is between two straight lines".to_owned()),
    };
    let unit_mm = before.unit_mm;
    Ok(Rounded {
        blocks: [
            before.block.clone(),
            pending.block.clone(),
            behind.block.clone(),
        ],
        corner,
        cut,
        feed: pending.feed,
        feed_behind: before.feed,
        to: places[2],
        unit_mm,
    })
}
