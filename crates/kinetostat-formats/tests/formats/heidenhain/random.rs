//! Random Heidenhain programs, broken by chance, and random programs that repeat and compute.

use kinetostat_formats::internal::expand_heidenhain_within as expand_within;
use kinetostat_formats::*;

use crate::harness::{Chance, Kind, broken};

/// With two rotary axes in the model.
fn followed() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.rotary_axes = vec!['A', 'C'];
    options
}

pub fn kind() -> Kind {
    Kind {
        words: &[
            "L X+1 Y+2 Z+3 FMAX\n",
            "L IX+1\n",
            "CC\n",
            "CC X+0 Y+0\n",
            "CR X+9 R+50 DR-\n",
            "LP IPA+30\n",
            "RND R1\n",
            "RND R0.2 F50\n",
            "CHF 0.3\n",
            "CHF 0.1 F70\n",
            "CHF 0.3\n",
            "CHF 0.1 F70\n",
            "LN X+1 NX+0 NY+0 NZ+1 TX+0.6 TY+0 TZ+0.8\n",
            "CP IPA+90 DR+\n",
            "DR-",
            "Q5",
            "~\n",
            ";",
            "\"",
            "M99",
            "M91",
            "FMAX",
            "CALL LBL 1\n",
            "CALL LBL 1 REP 2\n",
            "LBL 1\n",
            "LBL 0\n",
            "Q1 = 3 * (Q2 + 1)\n",
            "FN 9: IF +Q1 EQU +0 GOTO LBL 1\n",
            "CYCL DEF 7.1 X+5\n",
            "CYCL DEF 10.1 ROT+30\n",
            "CYCL DEF 11.1 SCL 0.1\n",
            "CYCL DEF 200 DRILL ~\n Q200=+2 ~\n Q201=-3 ~\n Q206=+9 ~\n Q203=+0\n",
            "TOOL CALL 2 Z F100\n",
            "END PGM A MM\n",
            "99999999999999999999 ",
            "M128\n",
            "M126\n",
            "L C+350 FMAX\n",
            " A+20 ",
            " IC-30 ",
        ],
        said: &REFUSED,
        own: flattened,
        ..Kind::of(Language::Heidenhain, followed(), |chance| {
            vec![program(chance)]
        })
    }
}

struct Writer<'c> {
    chance: &'c mut Chance,
    text: String,
    numbered: bool,
    count: usize,
    place: [f64; 3],
    style: usize,
    inch: bool,
    /// Rotary axes turn, under tool centre point control.
    turns: bool,
}

impl Writer<'_> {
    fn block(&mut self, text: &str) {
        if self.numbered {
            let gap = self.chance.of(&[" ", "  "]);
            self.text += &format!("{}{gap}", self.count);
        }
        self.count += 1;
        let end = self.chance.of(&["\n", "\n", "\n", " ; note\n", "  \n"]);
        self.text += &format!("{text}{end}");
    }

    fn number(&mut self, value: f64) -> String {
        // Arcs in inches need more digits.
        match (self.style, self.inch) {
            (0, false) => format!("{value:+.3}"),
            (1, false) => format!("{value:.4}"),
            (_, false) => format!("{value:+.3}").replace('.', ","),
            (0 | 1, true) => format!("{value:+.5}"),
            (_, true) => format!("{value:.6}").replace('.', ","),
        }
    }

    fn word(&mut self, letters: &str, value: f64) -> String {
        let number = self.number(value);
        format!(" {letters}{number}")
    }

    fn rounded(&mut self, size: f64) -> f64 {
        (self.chance.within(size) * 1e3).round() / 1e3
    }

    fn straight(&mut self) {
        let mut text = self.chance.of(&["L", "L "]).to_owned();
        for axis in 0..3 {
            let step = self.chance.below(4) == 0;
            match self.chance.below(3) {
                0 => {}
                _ if step => {
                    let by = self.rounded(10.0);
                    self.place[axis] += by;
                    text += &self.word(["IX", "IY", "IZ"][axis], by);
                }
                _ => {
                    self.place[axis] = self.rounded(200.0);
                    let to = self.place[axis];
                    text += &self.word(["X", "Y", "Z"][axis], to);
                }
            }
        }
        if self.turns && self.chance.below(3) == 0 {
            let letters = self.chance.of(&["A", "C", "IA", "IC"]);
            let angle = self.rounded(90.0);
            text += &self.word(letters, angle);
        }
        text += self.chance.of(&["", " R0", ""]);
        text += self.chance.of(&["", " FMAX", " F500", " F333.5"]);
        text += self.chance.of(&["", "", " M8", " M9", " M3 M8"]);
        self.block(&text);
    }

    fn arc(&mut self) {
        let (radius, first) = (20.0 + self.chance.within(15.0), self.chance.within(3.0));
        let by = self.chance.within(3.0);
        let by = by + by.signum() * 0.2;
        let [x, y, _] = self.place;
        let centre = [x - radius * first.cos(), y - radius * first.sin()];
        let sense = if by > 0.0 { "+" } else { "-" };
        let end = first + by;
        let to = [
            centre[0] + radius * end.cos(),
            centre[1] + radius * end.sin(),
        ];
        let pole = format!(
            "CC{}{}",
            self.word("X", centre[0]),
            self.word("Y", centre[1])
        );
        match self.chance.below(3) {
            0 => {
                self.block(&pole);
                let text = format!(
                    "C{}{} DR{sense}",
                    self.word("X", to[0]),
                    self.word("Y", to[1])
                );
                self.block(&text);
            }
            1 => {
                self.block(&pole);
                let degrees = by.to_degrees();
                let text = format!("CP{} IZ-1 DR{sense}", self.word("IPA", degrees));
                self.block(&text);
                self.place[2] -= 1.0;
            }
            _ => {
                let text = format!(
                    "CR{}{}{} DR{sense}",
                    self.word("X", to[0]),
                    self.word("Y", to[1]),
                    self.word(
                        "R",
                        if by.abs() > std::f64::consts::PI {
                            -radius
                        } else {
                            radius
                        }
                    )
                );
                self.block(&text);
            }
        }
        self.place[0] = to[0];
        self.place[1] = to[1];
    }

    /// All coordinates again: digits of arcs do not add up.
    fn all(&mut self, rest: &str) {
        self.place = [0, 1, 2].map(|_| self.rounded(200.0));
        let [x, y, z] = self.place;
        let text = format!(
            "L{}{}{}{rest}",
            self.word("X", x),
            self.word("Y", y),
            self.word("Z", z)
        );
        self.block(&text);
    }
}

/// A file that is understood.
pub fn program(chance: &mut Chance) -> String {
    let (numbered, style) = (chance.below(2) == 0, chance.below(3));
    let unit = chance.of(&["MM", "MM", "MM", "INCH"]);
    let mut writer = Writer {
        chance,
        text: String::new(),
        numbered,
        count: 0,
        place: [0.0; 3],
        style,
        inch: unit == "INCH",
        turns: false,
    };
    writer.block(&format!("BEGIN PGM R {unit}"));
    writer.block("BLK FORM 0.1 Z X+0 Y+0 Z-9");
    writer.block("TOOL CALL 3 Z S5000 F800");
    writer.block("L Z-10 R0 FMAX M91");
    writer.all(" R0 FMAX");
    if writer.chance.below(2) == 0 {
        writer.block("L A+0 C+0 FMAX");
        writer.block("M128");
        // Angles below 0: both axes count on.
        writer.block("L A-5 C-5 FMAX");
        writer.turns = true;
    }
    for _ in 0..writer.chance.below(16) {
        match writer.chance.below(12) {
            0..=4 => writer.straight(),
            5 | 6 => {
                writer.arc();
                writer.all("");
            }
            7 => {
                let shift = writer.rounded(50.0);
                writer.block("CYCL DEF 7.0 DATUM SHIFT");
                let text = format!("CYCL DEF 7.1{}", writer.word("X", shift));
                writer.block(&text);
                writer.all(" FMAX");
            }
            8 => {
                let bend = writer.chance.of(&[
                    "CYCL DEF 10.1 ROT+30",
                    "CYCL DEF 8.1 X Y",
                    "CYCL DEF 8.1 Y",
                    "CYCL DEF 11.1 SCL 0.5",
                ]);
                let reset = match bend.as_bytes()[9] {
                    b'8' => "CYCL DEF 8.1",
                    _ if bend.contains("ROT") => "CYCL DEF 10.1 ROT+0",
                    _ => "CYCL DEF 11.1 SCL 1",
                };
                writer.block(bend);
                writer.all(" FMAX");
                writer.straight();
                writer.arc();
                writer.block(reset);
                writer.all(" FMAX");
            }
            9 => {
                let pole = format!("CC{}{}", writer.word("X", 5.0), writer.word("Y", -5.0));
                writer.block(&pole);
                let first = format!("LP{}{}", writer.word("PR", 30.0), writer.word("PA", 20.0));
                writer.block(&first);
                let second = format!("LP{}", writer.word("IPA", 45.0));
                writer.block(&second);
                writer.all("");
            }
            10 => writer.block("* - operation"),
            _ => writer.block("L M140 MB MAX"),
        }
        if writer.text.ends_with("MB MAX\n") || writer.text.contains("M140") {
            writer.all(" FMAX");
        }
    }
    writer.block("L M30");
    writer.block(&format!("END PGM R {unit}"));
    match writer.chance.below(3) {
        0 => writer.text.replace('\n', "\r\n"),
        _ => writer.text,
    }
}

/// A program that repeats, counts and drills, and the places that a run of it by hand gives.
pub fn repeating(chance: &mut Chance) -> (String, Vec<[f64; 3]>) {
    let mut text = "BEGIN PGM R MM\nTOOL CALL 1 Z S1\nL X+0 Y+0 Z+10 FMAX\n".to_owned();
    let mut places = vec![[0.0, 0.0, 10.0]];
    let mut at = [0.0, 0.0, 10.0];
    for label in 1..=1 + chance.below(3) {
        let (steps, by) = (
            1 + chance.below(4),
            (chance.within(20.0) * 10.0).round() / 10.0,
        );
        match chance.below(3) {
            0 => {
                text += &format!(
                    "LBL {label}\nL IX{by:+} F100\nCALL LBL {label} REP {steps}/{steps}\n"
                );
                for _ in 0..=steps {
                    at[0] += by;
                    places.push(at);
                }
            }
            1 => {
                text += &format!(
                    "FN 0: Q{label} = +0\nLBL {label}\nFN 1: Q{label} = +Q{label} + +1\nL Y+Q{label} F100\nFN 12: IF +Q{label} LT +{steps} GOTO LBL {label}\n"
                );
                for step in 1..=steps {
                    at[1] = step as f64;
                    places.push(at);
                }
            }
            _ => {
                text += &format!(
                    "CYCL DEF 200 DRILLING ~\n Q200=+2 ~\n Q201=-{steps} ~\n Q206=+50 ~\n Q202=+1 ~\n Q203=+0 ~\n Q204=+10\nL X{by:+} FMAX M99\n"
                );
                at[0] = by;
                places.push(at);
                places.push([by, at[1], 2.0]);
                for peck in 1..=steps {
                    places.push([by, at[1], -(peck as f64)]);
                    places.push([by, at[1], 2.0]);
                    if peck < steps {
                        places.push([by, at[1], 2.0 - peck as f64]);
                    }
                }
                at[2] = 10.0;
                places.push(at);
            }
        }
    }
    text += "END PGM R MM\n";
    (text, places)
}

/// The flat text of the program, or of one that repeats, has a line of the file for each of its own.
fn flattened(chance: &mut Chance, kind: &mut Kind, files: &[Vec<u8>]) -> Result<(), String> {
    if chance.below(2) == 0 {
        kind.options.unknown_targets = UnknownTargets::LeftAsWritten;
    }
    kind.place_mm *= largest_scaling(&files[0]);
    let repeating = repeating(chance).0;
    let repeating = broken(chance, &repeating, kind);
    for bytes in [&files[0], &repeating] {
        is_flattened(bytes, &kind.options)?;
    }
    Ok(())
}

fn is_flattened(bytes: &[u8], options: &ReadOptions) -> Result<(), String> {
    let file = SourceFile::new("a.h", bytes);
    // Loops by chance are many.
    match expand_within(vec![file], options, 20_000) {
        Ok(flat) => {
            let lines = flat
                .file
                .bytes()
                .iter()
                .filter(|byte| **byte == b'\n')
                .count();
            let last = !flat.file.bytes().is_empty() && !flat.file.bytes().ends_with(b"\n");
            let count = lines + usize::from(last);
            let most = bytes.iter().filter(|byte| **byte == b'\n').count() + 1;
            let fits = |(file, line): &(usize, usize)| *file == 0 && (1..=most).contains(line);
            if flat.origins.len() != count || !flat.origins.iter().all(fits) {
                return Err(format!("{} origins of {count} lines", flat.origins.len()));
            }
            if !flat.changed && flat.file.bytes() != bytes {
                return Err("it says unchanged and is not".to_owned());
            }
            Ok(())
        }
        Err(errors) if errors.iter().all(|error| error.span.end <= bytes.len()) => Ok(()),
        Err(_) => Err("a fault without a place".to_owned()),
    }
}

/// The largest factor of a program that scales, at least 1: by so much its last decimal counts.
fn largest_scaling(bytes: &[u8]) -> f64 {
    let text = String::from_utf8_lossy(bytes).replace(',', ".");
    let behind = text.split("SCL").skip(1);
    let factors = behind.filter_map(|rest| {
        let rest = rest.trim_start();
        let is_part = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
        let length = rest.bytes().take_while(is_part).count();
        rest[..length].parse().ok()
    });
    kinetostat_testing::largest(factors.chain([1.0]))
}

const REFUSED: [&str; 2] = [
    "the arc begins at a place that changes",
    "it goes on from a place that changes, and its own end is not known",
];
