//! Random SINUMERIK programs, whole, and broken by chance.

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
            "G1 X1 Y2 Z3\n",
            "G91 ",
            "G90 ",
            "X=IC(1)",
            "G2 X5 Y5 CR=10\n",
            "CIP ",
            " RND=1\n",
            " CHF=0.5\n",
            "CHR=2",
            "TRANS X10\n",
            "ROT Z30\n",
            "R1=5\n",
            "X=R1*2+SIN(30)",
            "IF R1==1 GOTOF OUT\n",
            "LOOP\n",
            "ENDLOOP\n",
            "ENDIF\n",
            "REPEAT LAST P=3\n",
            "CYCLE83(5,0,1,-20,,,10,3,0,0,1,0)\n",
            "R1=R1+1\n",
            "SUPA ",
            "TRAORI\n",
            "A3=0 B3=1 C3=1",
            "M30\n",
            "MSG(\"",
            "((((((",
            "DEF REAL A[9,9]\n",
            "CYCLE81(1,2,3)\n",
            "G700 ",
            ";",
            " A20 ",
            " C=DC(350) ",
            " C=ACP(R1) ",
            "ORIAXES\n",
        ],
        own: runs_flat,
        ..Kind::of(Language::Siemens, followed(), |chance| {
            vec![program(chance)]
        })
    }
}

struct Writer<'c> {
    chance: &'c mut Chance,
    text: String,
    number: usize,
    place: [f64; 3],
    steps: bool,
    /// Rotary axes turn, under TRAORI.
    turns: bool,
}

fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

impl Writer<'_> {
    fn line(&mut self, words: &str) {
        self.number += 10;
        let begin = match self.chance.below(4) {
            0 => String::new(),
            1 => format!("N{}", self.number),
            _ => format!("N{} ", self.number),
        };
        let end = self.chance.of(&["", "", "", " ; note X1", "  "]);
        self.text += &format!("{begin}{words}{end}\n");
    }

    /// A word of an axis to another place, as it may be written.
    fn axis(&mut self, axis: usize, to: f64) -> String {
        let (letter, from) = (["X", "Y", "Z"][axis], self.place[axis]);
        self.place[axis] = to;
        let by = rounded(to - from);
        match (self.chance.below(7), self.steps) {
            (0, _) => format!("{letter}=AC({to})"),
            (1, _) => {
                self.place[axis] = rounded(from + by);
                format!("{letter}=IC({by})")
            }
            (2, false) => format!("{letter}={}+{to}-{}", 3, 3),
            (_, true) => {
                self.place[axis] = rounded(from + by);
                format!("{letter}{by}")
            }
            (3, false) => format!("{letter}{to:.3}"),
            (4, false) => format!("{letter}={to:.4}"),
            _ => format!("{letter}{to}"),
        }
    }

    fn straight(&mut self, code: &str) {
        let mut words = Vec::new();
        for axis in 0..3 {
            if self.chance.below(3) > 0 {
                let to = rounded(self.chance.within(300.0));
                words.push(self.axis(axis, to));
            }
        }
        if words.is_empty() {
            words.push(self.axis(0, 7.5));
        }
        if self.chance.below(5) == 0 {
            words.push(
                self.chance
                    .of(&["F500", "F1200.5", "M8", "M0", "G9"])
                    .to_owned(),
            );
        }
        if self.turns && self.chance.below(3) == 0 {
            let angle = rounded(self.chance.within(90.0));
            words.push(match self.chance.below(4) {
                0 => format!("A=IC({angle})"),
                1 => format!("C=DC({})", angle.abs()),
                2 => format!("C=AC({})", angle.abs()),
                _ => format!("A=AC({angle}) C=ACN({})", angle.abs()),
            });
        }
        let code = match self.chance.below(4) {
            0 if code == "G1" => "G01",
            _ => code,
        };
        let between = self.chance.of(&[" ", " ", "  ", ""]);
        let words = words.join(" ");
        self.line(&format!("{code}{between}{words}"));
    }

    fn arc(&mut self) {
        let (radius, first) = (5.0 + self.chance.within(4.0), self.chance.within(3.0));
        let by = 3.0 + self.chance.within(2.9);
        let [x, y, z] = self.place;
        let turn = self.chance.below(2) == 0;
        let (i, j) = (-radius * first.cos(), -radius * first.sin());
        let last = match turn {
            true => first + by,
            false => first - by,
        };
        let end = [
            rounded(x + i + radius * last.cos()),
            rounded(y + j + radius * last.sin()),
        ];
        let code = if turn { "G3" } else { "G2" };
        let (i, j) = (rounded(i), rounded(j));
        let middle = 0.5 * (first + last);
        let via = [
            rounded(x + i + radius * middle.cos()),
            rounded(y + j + radius * middle.sin()),
        ];
        self.place = [end[0], end[1], z];
        let words = match self.chance.below(4) {
            0 => format!(
                "CIP X=AC({}) Y=AC({}) I1=AC({}) J1=AC({})",
                end[0], end[1], via[0], via[1]
            ),
            1 => format!(
                "{code} X=AC({}) Y=AC({}) AR={}",
                end[0],
                end[1],
                by.to_degrees()
            ),
            2 => format!(
                "{code} X=AC({}) Y=AC({}) I=AC({}) J=AC({})",
                end[0],
                end[1],
                rounded(x + i),
                rounded(y + j)
            ),
            _ => format!("{code} X=AC({}) Y=AC({}) I{i} J{j}", end[0], end[1]),
        };
        self.line(&words);
    }
}

/// A program that is understood.
pub fn program(chance: &mut Chance) -> String {
    let mut writer = Writer {
        chance,
        text: "%_N_A_MPF\n;$PATH=/_N_MPF_DIR\n".to_owned(),
        number: 0,
        place: [0.0; 3],
        steps: false,
        turns: false,
    };
    writer.line("G17 G90 G94 G71 G54");
    writer.line("T1 D1 M6");
    let first = [0, 1, 2].map(|_| rounded(writer.chance.within(100.0)));
    writer.place = first;
    let [x, y, z] = first;
    writer.line(&format!("G0 X{x} Y{y} Z{z}"));
    writer.line("F600");
    if writer.chance.below(2) == 0 {
        writer.line("TRAORI");
        writer.line(&format!("G0 X{x} Y{y} Z{z} A-5 C0"));
        writer.turns = true;
    }
    for _ in 0..writer.chance.below(16) {
        match writer.chance.below(14) {
            0 => writer.arc(),
            1 => writer.arc(),
            2 => writer.straight("G0"),
            3 => {
                writer.steps = !writer.steps;
                let code = if writer.steps { "G91" } else { "G90" };
                writer.line(code);
            }
            4 => {
                // The generator's own place is in no frame: all is stated again.
                let frame = writer.chance.of(&[
                    "TRANS X10 Y-5",
                    "ATRANS Z3.5",
                    "ROT Z30",
                    "AROT X10 Y-20 Z5",
                    "ROT RPL=45",
                    "TRANS",
                ]);
                writer.line(frame);
                let place = [0, 1, 2].map(|_| rounded(writer.chance.within(100.0)));
                writer.place = place;
                let [x, y, z] = place;
                writer.line(&format!("G1 X=AC({x}) Y=AC({y}) Z=AC({z})"));
            }
            5 => {
                let line = writer.chance.of(&[
                    "MSG(\"X1 (\")",
                    "G64 SOFT",
                    "R7=3*(4-2)",
                    "M8",
                    "G4 F1",
                    "CYCLE832(0.01,_FINISH,1)",
                    "S5000 M3",
                    "COMPCAD FFWON",
                    "F850",
                ]);
                writer.line(line);
            }
            6 => {
                writer.line("SUPA G0 Z0");
                let z = rounded(writer.chance.within(100.0));
                writer.place[2] = z;
                writer.line(&format!("Z=AC({z})"));
            }
            _ => writer.straight("G1"),
        }
    }
    writer.line("M30");
    match writer.chance.below(3) {
        0 => writer.text.replace('\n', "\r\n"),
        _ => writer.text,
    }
}

/// A program with loops, branches and calls, and how often its line with `X` of a counter runs.
pub fn looping(chance: &mut Chance) -> (String, usize) {
    let (outer, inner) = (1 + chance.below(4), 1 + chance.below(4));
    let begin = match chance.below(2) {
        0 => format!("FOR R1=1 TO {outer}"),
        _ => "R1=0\nREPEAT\nR1=R1+1 ; counts".to_owned(),
    };
    let end = match begin.starts_with('F') {
        true => "ENDFOR".to_owned(),
        false => format!("UNTIL R1>={outer}"),
    };
    let jump = chance.of(&["GOTOB AGAIN", "GOTO AGAIN"]);
    let text = format!(
        "G17 G90 G94 F600\nG0 X0 Y0 Z5\n{begin}\nR2=0\nAGAIN: R2=R2+1\nG1 X=R1*10+R2 Y=SIN(R2*30) Z=-R1\nIF R2<{inner} {jump}\n{end}\nLAST: G0 Z5\nENDLABEL: Z6\nREPEAT LAST P=2\nM30\n"
    );
    (text, outer * inner + 7)
}

/// One case of a program that is run flat, whole or broken: it is refused by line, or what it gives is read.
fn runs_flat(chance: &mut Chance, kind: &mut Kind, _: &[Vec<u8>]) -> Result<(), String> {
    if chance.below(3) > 0 {
        return Ok(());
    }
    let (whole, count) = looping(chance);
    let bytes = broken(chance, &whole, kind);
    let same = bytes == whole.as_bytes();
    let files = [SourceFile::new("a.mpf", bytes.clone())];
    let flat = match kinetostat_formats::internal::expand_siemens_within(&files, 100_000) {
        Ok(flat) => flat,
        Err(errors) => {
            let lines = files[0].line_count();
            let fits = |error: &ProgramError| (1..=lines).contains(&error.line);
            return match same || !errors.iter().all(fits) || errors.is_empty() {
                true => Err(format!("{errors:?}")),
                false => Ok(()),
            };
        }
    };
    if !flat.changed && flat.file.bytes() != bytes {
        return Err("bytes changed where nothing was to do".to_owned());
    }
    let read = read_siemens(vec![flat.file], &kind.options);
    match (same, read) {
        (true, Ok(program)) if program.motions.len() == count => Ok(()),
        (true, found) => Err(format!("{:?}", found.map(|p| p.motions.len()))),
        (false, _) => Ok(()),
    }
}
