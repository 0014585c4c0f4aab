//! Cycles: what they define, and the holes that their calls drill.

use crate::flat_run::BlockId;
use crate::heidenhain::datum::KEPT;
use crate::heidenhain::expand::hole::{Hole, Stroke};
use crate::heidenhain::expand::run::{Fault, Run};
use crate::heidenhain::expand::values::{Parameters, begins_value};
use crate::heidenhain::words::{Value, Word, length, words_of};
use crate::options::UnknownTargets;
use crate::text::number::short;

/// Parameters of the drilling cycles.
const OWN: [&str; 15] = [
    "Q200", "Q201", "Q202", "Q203", "Q204", "Q205", "Q206", "Q208", "Q210", "Q211", "Q212", "Q213",
    "Q256", "Q379", "Q395",
];

/// Parameters without which the position of a hole is unknown: set-up clearance, depth, surface.
const NEEDED: [&str; 3] = ["Q200", "Q201", "Q203"];

/// The words of a cycle whose name ends before its first parameter: of `DRILLING Q200=+2` the letters take the parameter for their value.
fn named(bytes: &[u8], words: &[Word]) -> Option<Vec<Word>> {
    let last = words.last()?.span.end;
    let at = (2..words.len().saturating_sub(1)).find(|i| {
        matches!(words[*i].value, Value::Parameter { .. }) && begins_value(&words[i + 1], bytes)
    })?;
    let Value::Parameter { name, .. } = &words[at].value else {
        return None;
    };
    let mut parted = words[..at].to_vec();
    parted.extend(words_of(bytes, &(name.start..last)));
    Some(parted)
}

/// Coordinates of the tool's axis between which a cycle that stays is called.
struct Heights {
    /// Start above the hole.
    begin: f64,
    /// Retraction behind the cycle.
    end: f64,
}

impl Run<'_> {
    pub(crate) fn cycle(&mut self, at: BlockId, words: &[Word]) -> Result<(), Fault> {
        let file = self.programs[at.file].file;
        let parted = named(file.bytes(), words);
        let words = parted.as_deref().unwrap_or(words);
        let Some(kind) = words.get(1) else {
            return self.substituted(at, words).map(|_| ());
        };
        if kind.is("CALL") {
            let plain = words.len() == 2 || words[2].is("M");
            if !plain {
                return Err(self.fault(
                    at,
                    "the cycle is called at places of its own",
                    "call it with M99 or CYCL CALL",
                ));
            }
            let text = self.text(at, words)?;
            let rest = match text
                .windows(4)
                .position(|part| part.eq_ignore_ascii_case(b"CALL"))
            {
                Some(call) => text[call + 4..].trim_ascii().to_vec(),
                None => Vec::new(),
            };
            if self.is_left(at)? {
                self.write(&text, at);
                return Ok(());
            }
            if rest.first().is_some_and(|byte| *byte != b';') {
                self.write(&rest, at);
            }
            return self.drill(at);
        }
        let number = kind.number().filter(|_| kind.is("DEF"));
        let Some(number) = number else {
            self.substituted(at, words)?;
            return Ok(());
        };
        let text = String::from_utf8_lossy(file.part(&number.span)).into_owned();
        let mut parts = text.splitn(2, ['.', ',']);
        let mut part = || parts.next().and_then(|text| text.parse::<u32>().ok());
        let (cycle, part) = (part().unwrap_or(0), part().unwrap_or(0));
        let has_values = words
            .windows(2)
            .any(|pair| pair[0].is("Q") && begins_value(&pair[1], file.bytes()));
        if matches!(cycle, 200 | 201 | 203) || KEPT.contains(&cycle) {
            // Parameters of an earlier cycle are not valid for this one.
            for name in OWN {
                self.parameters.remove(name);
            }
            self.rapid_out = false;
        }
        if has_values {
            self.assign(at, &words[2..])?;
        }
        match cycle {
            // DEF-active cycles.
            7..=11 | 13 | 14 | 19 | 20 | 26 | 32 | 39 | 220..=299 | 400..=499
                if !(240..=246).contains(&cycle) && !(250..=290).contains(&cycle) =>
            {
                self.substituted(at, words)?;
            }
            200 | 201 | 203 => {
                self.cycle_refused = false;
                self.cycle = Some(cycle);
                self.modal = false;
            }
            1 => {
                if part == 0 {
                    self.pecking = [None; 6];
                    self.cycle_refused = false;
                    self.cycle = Some(1);
                    self.modal = false;
                }
                let flat = self.text(at, words)?;
                let flat_words = words_of(&flat, &(0..flat.len()));
                let value = flat_words.iter().skip(2).find_map(Word::value);
                if let Some(slot) = self.pecking.get_mut(part as usize) {
                    *slot = value;
                }
            }
            _ => {
                self.cycle_refused = false;
                self.cycle = Some(cycle);
                self.modal = false;
                self.substituted(at, words)?;
            }
        }
        Ok(())
    }

    /// True if the called cycle stays a cycle.
    pub(crate) fn is_left(&self, at: BlockId) -> Result<bool, Fault> {
        match self.cycle {
            _ if self.cycle_refused => Ok(false),
            None => Err(self.fault(at, "no cycle is defined that could be called", "define it before")),
            Some(1 | 200 | 201 | 203) => Ok(false),
            Some(_) if self.heights_of_kept().is_some() => Ok(false),
            Some(number) if self.options.unknown_targets == UnknownTargets::Refused => Err(self
                .fault(
                    at,
                    format!("cycle {number} is called, and what it does is not followed"),
                    "leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or let the CAM system write L blocks",
                )),
            Some(_) => Ok(true),
        }
    }

    /// Heights of a cycle that stays; `None` for other cycles.
    fn heights_of_kept(&self) -> Option<Heights> {
        self.cycle.filter(|cycle| KEPT.contains(cycle))?;
        let surface = self.parameters.value("Q203")?;
        let begin = surface + self.parameters.value("Q200")?;
        let second = self.parameters.value("Q204").unwrap_or(0.0);
        Some(Heights {
            begin,
            end: begin.max(surface + second),
        })
    }

    /// A cycle whose way is the control's own: its call, between the blocks that lead over the hole and away.
    fn keep_cycle(&mut self, at: BlockId, heights: &Heights) {
        let to = |height: f64| {
            let height = length(height, self.unit_mm);
            format!("L {}{height} R0 FMAX", self.axis)
        };
        for text in [to(heights.begin), "CYCL CALL".to_owned(), to(heights.end)] {
            self.write(text.as_bytes(), at);
        }
        self.feed_lost |= self.feed.is_some();
    }

    /// The blocks of a hole.
    pub(crate) fn drill(&mut self, at: BlockId) -> Result<(), Fault> {
        if self.cycle_refused {
            return Ok(());
        }
        if let Some(heights) = self.heights_of_kept() {
            self.keep_cycle(at, &heights);
            return Ok(());
        }
        let value = |name: &str| self.parameters.value(name).unwrap_or(0.0);
        let cycle = self.cycle.unwrap_or(0);
        let missing = NEEDED
            .iter()
            .find(|name| self.parameters.value(name).is_none());
        if let (Some(name), 200 | 201 | 203) = (missing, cycle) {
            return Err(self.fault(
                at,
                format!("{name} of cycle {cycle} is stated nowhere"),
                "state it in the definition of the cycle",
            ));
        }
        if cycle != 1 && value("Q395") != 0.0 {
            return Err(self.fault(
                at,
                "the depth is that of the drill's full diameter (Q395), which its tip says",
                "state the depth of the tip: Q395=+0",
            ));
        }
        let hole = match cycle {
            1 => Hole::pecked(&self.pecking, self.unit_mm),
            _ => {
                let retract = (!self.rapid_out).then(|| value("Q208"));
                Hole::drilled(cycle, value, retract, self.unit_mm)
            }
        };
        let strokes = hole.strokes();
        let strokes =
            strokes.map_err(|reason| self.fault(at, reason, "mend the cycle's values"))?;
        for stroke in strokes {
            let (letters, value, feed) = match stroke {
                Stroke::To(to, feed) => (self.axis.to_owned(), to, feed),
                Stroke::By(by, feed) => (format!("I{}", self.axis), by, feed),
                Stroke::Dwell(seconds) => {
                    self.write(b"CYCL DEF 9.0 DWELL TIME", at);
                    let text = format!("CYCL DEF 9.1 DWELL {}", short(seconds, 3));
                    self.write(text.as_bytes(), at);
                    continue;
                }
            };
            let feed = match feed {
                Some(feed) => {
                    self.feed_lost = true;
                    format!("F{}", short(feed, 3))
                }
                None => "FMAX".to_owned(),
            };
            let text = format!("L {letters}{} R0 {feed}", length(value, self.unit_mm));
            self.write(text.as_bytes(), at);
        }
        Ok(())
    }
}
