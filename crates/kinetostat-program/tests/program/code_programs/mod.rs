//! Random programs with every code: what is unknown is refused with its line, what is known stands in the
//! piece where it acts. Shared by a test and by `cargo xtask fuzz`.

use kinetostat_program::*;
use nalgebra::Vector3;

/// G codes that are read, in tenths; from the manuals, not from the table of the crate.
pub const READ: [u32; 50] = [
    0, 10, 20, 30, 40, 80, 90, 150, 170, 180, 190, 200, 210, 280, 300, 400, 430, 431, 432, 490,
    530, 540, 550, 560, 570, 580, 590, 591, 592, 593, 610, 611, 640, 690, 800, 900, 901, 910, 911,
    920, 921, 922, 923, 930, 940, 950, 960, 970, 980, 990,
];

/// M codes that act before the motion on every controller that a source could be named for.
pub const BEFORE: [u32; 21] = [
    3, 4, 7, 8, 13, 14, 48, 49, 50, 51, 52, 53, 62, 63, 64, 65, 66, 67, 68, 82, 83,
];

/// M codes that act after it, and those that stop something and act after it on some.
pub const AFTER: [u32; 7] = [0, 1, 2, 5, 9, 30, 60];

/// M codes of one modal group, by the manual of LinuxCNC (chapter G-code overview, modal groups), with the codes
/// of spindle and coolant together that other controllers have. Mist and flood (M7, M8) go together.
const GROUPS: [&[u32]; 5] = [
    &[0, 1, 2, 30, 60],
    &[3, 4, 5, 13, 14, 19],
    &[7, 8, 9],
    &[48, 49],
    &[82, 83],
];

/// Whether two M codes must not stand in one block.
pub fn exclude_each_other(a: u32, b: u32) -> bool {
    let both_on = [a, b].iter().all(|code| [7, 8].contains(code)) && a != b;
    !both_on
        && GROUPS
            .iter()
            .any(|group| group.contains(&a) && group.contains(&b))
}

/// What a case found.
#[derive(Debug, Default, Clone, Copy)]
pub struct CaseOutcome {
    /// Whether the program was taken.
    pub taken: bool,
    /// Lines refused.
    pub refused: usize,
    /// Blocks divided.
    pub divided: usize,
    /// Codes looked for in the pieces of divided blocks.
    pub placed: usize,
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    fn once_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

/// One line and what must become of it.
struct Line {
    text: String,
    /// Holds a code that must be refused, or two that must not stand together.
    unknown: bool,
    /// M words as spelled, and whether they belong to the last piece.
    codes: Vec<(String, bool)>,
}

fn spelled(random: &mut Random, letter: char, tenths: u32) -> String {
    let (whole, tenth) = (tenths / 10, tenths % 10);
    let zero = if whole < 10 && random.once_in(3) {
        "0"
    } else {
        ""
    };
    let tail = match (tenth, random.below(4)) {
        (0, 0) => ".0".to_owned(),
        (0, 1) => ".".to_owned(),
        (0, _) => String::new(),
        (tenth, 0) => format!(".{tenth}0"),
        (tenth, _) => format!(".{tenth}"),
    };
    let letter = if random.once_in(4) {
        letter.to_ascii_lowercase()
    } else {
        letter
    };
    format!("{letter}{zero}{whole}{tail}")
}

fn line(random: &mut Random, wild: bool) -> Line {
    let feeds = random.once_in(2);
    let mut words = vec![if feeds { "G1" } else { "G0" }.to_owned()];
    let moves = !random.once_in(4);
    if moves {
        words.push(format!("X{}", random.below(200)));
        words.push(format!("Y{}", random.below(200)));
        if feeds {
            words.push(format!("F{}", 100 + random.below(900)));
        }
    } else {
        words.clear();
    }
    let mut unknown = false;
    // A motion to a place of the machine (G28, G30, G53) is carried as it stands: it has no pieces.
    let mut unknown_beside = false;
    let mut codes: Vec<(String, bool)> = Vec::new();
    let mut used = Vec::new();
    let mut numbers: Vec<u32> = Vec::new();
    for _ in 0..random.below(4) {
        let (letter, tenths) = if wild && random.once_in(2) {
            if random.once_in(2) {
                ('G', random.below(1000) as u32)
            } else {
                let most = if random.once_in(2) { 1000 } else { 9990 };
                ('M', random.below(most) as u32)
            }
        } else {
            let list = if random.once_in(2) {
                &BEFORE[..]
            } else {
                &[0, 1, 5, 9, 60]
            };
            ('M', 10 * random.of(list))
        };
        let code = tenths / 10;
        // Two codes of one group are refused, too.
        let excluded = letter == 'M'
            && tenths % 10 == 0
            && numbers.iter().any(|other| exclude_each_other(code, *other));
        if used.contains(&tenths) || letter == 'M' && [82, 83].contains(&code) && !used.is_empty() {
            continue;
        }
        if excluded && !random.once_in(6) {
            continue;
        }
        unknown |= excluded;
        used.push(tenths);
        let text = spelled(random, letter, tenths);
        let known = match letter {
            'G' => READ.contains(&tenths),
            _ => tenths % 10 == 0,
        };
        unknown |= !known;
        let has_moment = BEFORE.contains(&code) || AFTER.contains(&code) || [6, 19].contains(&code);
        unknown_beside |= letter == 'M' && moves && !has_moment;
        if letter == 'M' {
            if tenths % 10 == 0 {
                numbers.push(code);
            }
            codes.push((text.clone(), AFTER.contains(&code)));
        }
        let at = random.below(words.len() + 1);
        words.insert(at, text);
    }
    let is_carried = used.iter().any(|tenths| [280, 300, 530].contains(tenths));
    Line {
        text: words.join(" "),
        unknown: unknown || unknown_beside && !is_carried,
        codes,
    }
}

/// Bends z by 1 um at 10 mm, 100 um at 100 mm.
fn bend(request: &Request) -> Result<Vector3<f64>, FieldFailure> {
    let z = 1e-5 * request.position_mm.xy().norm_squared();
    Ok(Vector3::new(0.0, 0.0, z))
}

/// Checks one program.
pub fn check(seed: u64) -> Result<CaseOutcome, String> {
    let mut random = Random(seed);
    let wild = random.once_in(2);
    let lines: Vec<Line> = (0..1 + random.below(12))
        .map(|_| line(&mut random, wild))
        .collect();
    let mut text = "G21 G90\nG0 X0 Y0 Z0\n".to_owned();
    for line in &lines {
        text.push_str(&line.text);
        text.push('\n');
    }
    let fail = |what: &str| Err(format!("case {seed}: {what}\n{text}"));
    let reading = ReadOptions::default();
    let refused: Vec<usize> = faults(text.as_bytes(), &reading)
        .iter()
        .map(|fault| fault.line)
        .collect();
    for (index, line) in lines.iter().enumerate() {
        if line.unknown && !refused.contains(&(index + 3)) {
            return fail(&format!(
                "line {} has an unknown code and is not refused",
                index + 3
            ));
        }
    }
    let mut found = CaseOutcome {
        refused: refused.len(),
        ..CaseOutcome::default()
    };
    let read = Program::read(text.as_bytes()).and_then(|program| {
        let path = interpret(&program, &reading)?;
        Ok((program, path))
    });
    let (program, path) = match read {
        Ok(_) if !refused.is_empty() => return fail("it is taken and has faults"),
        Err(_) if refused.is_empty() => return fail("it is refused and has no faults"),
        Err(_) => return Ok(found),
        Ok(both) => both,
    };
    found.taken = true;
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing
    };
    let written = match write_corrected(&program, &path, &bend, &writing, &Unwatched) {
        Ok(written) => written,
        Err(error) => return fail(&error.to_string()),
    };
    if let Err(error) = verify_written(&program, &path, &written, &reading, &writing) {
        return fail(&error.to_string());
    }
    let output = String::from_utf8_lossy(&written.bytes).into_owned();
    let output: Vec<&str> = output.lines().collect();
    for (move_index, motion) in path
        .moves
        .iter()
        .enumerate()
        .filter(|(_, motion)| motion.line > 2)
    {
        let own: Vec<&str> = written
            .pieces
            .iter()
            .filter(|piece| piece.move_index == move_index)
            .map(|piece| output[piece.output_line - 1])
            .collect();
        if own.len() < 2 {
            continue;
        }
        found.divided += 1;
        for (code, last) in &lines[motion.line - 3].codes {
            let has = |line: &&str| line.split(' ').any(|word| word == code);
            let places: Vec<usize> = (0..own.len()).filter(|&index| has(&own[index])).collect();
            if places != [if *last { own.len() - 1 } else { 0 }] {
                return fail(&format!(
                    "{code} of line {} appears in the pieces {places:?} of {}",
                    motion.line,
                    own.len()
                ));
            }
            found.placed += 1;
        }
    }
    Ok(found)
}
