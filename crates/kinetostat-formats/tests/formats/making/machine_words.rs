//! Random blocks of SINUMERIK and Heidenhain programs with words beside motions and alone: each word is in the other language, on
//! its side of its motion and in order, or named. What is expected comes from the words that were chosen, not from the text.

use kinetostat_formats::*;

use super::{found, of_robot, text_of};
use crate::harness::Chance;

/// A block, and what it does: before its motion, and behind it.
#[derive(Default)]
struct Block {
    text: String,
    /// Lines of the program up to its own.
    line: usize,
    /// Where along X it goes.
    goes: Option<usize>,
    early: Vec<String>,
    late: Vec<String>,
    /// In G-code.
    acts: [Vec<String>; 2],
    /// Of the spindle, of coolant, of other kinds.
    has: [bool; 3],
    waits: Option<f64>,
    stops: bool,
}

/// What the spindle does.
#[derive(Default)]
struct Spindle {
    word: Option<&'static str>,
    speed: Option<usize>,
}

impl Block {
    fn say(&mut self, word: &str, is_late: bool, act: Option<String>) {
        let side = usize::from(is_late);
        match is_late {
            true => self.late.push(word.to_owned()),
            false => self.early.push(word.to_owned()),
        }
        self.acts[side].extend(act);
    }

    /// Words of the spindle: `S`, `M3`, `M4`, or `M5`.
    fn turn(
        &mut self,
        chance: &mut Chance,
        spindle: &mut Spindle,
        (is_path, stops_late): (bool, bool),
    ) {
        self.has[0] = true;
        // S stands in path blocks alone at Heidenhain.
        let choice = match is_path {
            true => chance.below(4),
            false => [1, 3][chance.below(2)],
        };
        if choice == 3 {
            *spindle = Spindle {
                word: None,
                ..*spindle
            };
            return self.say("M5", stops_late, Some("M5".to_owned()));
        }
        let speed = (choice != 1).then(|| 100 + chance.below(9000));
        spindle.speed = speed.or(spindle.speed);
        let word = (choice != 0).then(|| ["M3", "M4"][chance.below(2)]);
        spindle.word = word.or(spindle.word);
        let act = spindle.word.map(|word| match spindle.speed {
            Some(speed) => format!("S{speed} {word}"),
            None => word.to_owned(),
        });
        let mut words: Vec<String> = speed.map(|speed| format!("S{speed}")).into_iter().collect();
        words.extend(word.map(str::to_owned));
        if chance.below(2) == 0 {
            words.reverse();
        }
        self.say(&words.join(" "), false, act);
    }

    fn coolant(&mut self, chance: &mut Chance, stops_late: bool) {
        self.has[1] = true;
        let word = ["M7", "M8", "M9"][chance.below(3)];
        self.say(word, word == "M9" && stops_late, Some(word.to_owned()));
    }

    /// Words that no other language has.
    fn other(&mut self, chance: &mut Chance, from: Language) {
        self.has[2] = true;
        let number = 200 + chance.below(700);
        let word = match from {
            Language::Siemens => format!("{}{number}", ["H", "M"][chance.below(2)]),
            _ => format!("M{number}"),
        };
        self.say(&word, false, None);
    }

    fn stop(&mut self, chance: &mut Chance) {
        self.stops = true;
        let word = ["M0", "M1"][chance.below(2)];
        self.late.push(word.to_owned());
    }

    fn dwell(&mut self, chance: &mut Chance, from: Language) -> String {
        let seconds = (1 + chance.below(80)) as f64 / 8.0;
        self.waits = Some(seconds);
        self.acts[0].push(format!("G4 X{seconds:?}"));
        let (text, note) = match (from, chance.below(2)) {
            (Language::Siemens, _) => (format!("G4 F{seconds}"), format!("G4 F{seconds}")),
            (_, 0) => {
                let second = format!("CYCL DEF 9.1 DWELL {seconds}");
                (format!("CYCL DEF 9.0 DWELL TIME\n{second}"), second)
            }
            _ => {
                let text = format!("FUNCTION DWELL TIME{seconds}");
                (text.clone(), text)
            }
        };
        self.early.push(note);
        text
    }
}

/// Blocks of a program, with the first place and the end.
fn blocks(chance: &mut Chance, from: Language, count: usize) -> Vec<Block> {
    let mut spindle = Spindle::default();
    let mut at = 0;
    let mut line = match from {
        Language::Siemens => 2,
        _ => 3,
    };
    let mut all = Vec::new();
    for index in 0..count {
        let mut block = Block::default();
        let moves = index == 0 || chance.below(3) > 0;
        let stops_late = moves || from == Language::Heidenhain;
        let mut text = String::new();
        if !moves && chance.below(4) == 0 {
            text = block.dwell(chance, from);
        } else {
            let chosen = [0; 4].map(|_| chance.below(3) == 0);
            if chosen[0] {
                let is_path = moves || from == Language::Siemens;
                block.turn(chance, &mut spindle, (is_path, stops_late));
            }
            if chosen[1] {
                block.coolant(chance, stops_late);
            }
            if chosen[2] {
                block.other(chance, from);
            }
            if chosen[3] {
                block.stop(chance);
            }
            if block.stops {
                let last = block.late.last().cloned();
                block.acts[1].extend(last);
            }
        }
        if moves {
            at += 1;
            block.goes = Some(at);
        }
        if text.is_empty() {
            text = text_of_block(chance, from, &block);
        }
        if text.is_empty() {
            continue;
        }
        block.line = line + text.matches('\n').count();
        line = block.line + 1;
        block.text = text;
        all.push(block);
    }
    all
}

/// The words of a block in a line: those that act early in their order, those that act late among them.
fn text_of_block(chance: &mut Chance, from: Language, block: &Block) -> String {
    let mut words: Vec<String> = block.early.clone();
    for word in &block.late {
        let at = match word.as_str() {
            // Of several that act behind the motion, the order is that of the words, and stops are last.
            "M0" | "M1" => chance.below(words.len() + 1),
            _ => words.len(),
        };
        words.insert(at, word.clone());
    }
    match (from, block.goes) {
        (Language::Siemens, goes) => {
            let mut motion: Vec<String> = goes.map(|x| format!("X{x}")).into_iter().collect();
            if chance.below(3) == 0 {
                motion.push(["G90", "G64", "F600", "G9"][chance.below(4)].to_owned());
            }
            for word in motion {
                words.insert(chance.below(words.len() + 1), word);
            }
            words.join(" ")
        }
        (_, Some(x)) => {
            let feed = ["", " F600", " R0", " R0 FMAX"][chance.below(4)];
            format!("L X+{x}{feed} {}", words.join(" "))
        }
        (_, None) => words.join(" "),
    }
}

fn program(from: Language, blocks: &[Block]) -> String {
    let texts: Vec<&str> = blocks.iter().map(|block| block.text.as_str()).collect();
    // The first place is stated whole.
    let body = texts.join("\n");
    let body = match from {
        Language::Siemens => body.replacen("X1", "X1 Y0 Z0", 1),
        _ => body.replacen("L X+1", "L X+1 Y+0 Z+0", 1),
    };
    match from {
        Language::Siemens => format!("G90 G71 G94 G17 G54 G1 F600\n{body}\nM30\n"),
        _ => format!("BEGIN PGM A MM\nF600\n{body}\nEND PGM A MM\n"),
    }
}

/// The motions of G-code by their X, and what else it does.
fn acts_of(text: &str) -> Vec<String> {
    let lines = text.lines().skip(2).filter(|line| !line.starts_with('('));
    let act = |line: &str| match line.split_once(" X") {
        Some((word, rest)) if word != "G4" => {
            let x = rest.split('.').next().unwrap_or_default();
            format!("to {x}")
        }
        _ => line.to_owned(),
    };
    lines.map(act).collect()
}

/// Motions, stops and pauses of a robot's program in order, and its notes by the line of the source.
fn steps_of(text: &str, into: MakeLanguage) -> Vec<String> {
    let mut steps = Vec::new();
    for line in text.lines() {
        let x = match into {
            MakeLanguage::Krl => line.split_once("{X "),
            MakeLanguage::Rapid => line.split_once(" [["),
            _ => None,
        };
        let number = |text: &str| {
            let digits = text.trim_start_matches(|c: char| !c.is_ascii_digit());
            let end = digits.find(|c: char| !c.is_ascii_digit() && c != '.');
            digits[..end.unwrap_or(digits.len())]
                .parse::<f64>()
                .unwrap()
        };
        let trimmed = line.trim().trim_end_matches(';').trim();
        if let Some((_, note)) = line.split_once("line ") {
            steps.push(format!("note {}", note.trim()));
        } else if trimmed == "HALT" || trimmed == "Stop" {
            steps.push("stop".to_owned());
        } else if trimmed.starts_with("WAIT SEC") || trimmed.starts_with("WaitTime") {
            steps.push(format!("wait {}", number(trimmed)));
        } else if let Some((head, rest)) = x
            && ["LIN", "PTP", "MoveL", "MoveJ"]
                .iter()
                .any(|word| head.trim_start().starts_with(word))
        {
            steps.push(format!("to {}", number(rest)));
        }
    }
    steps
}

fn wanted_steps(blocks: &[Block]) -> Vec<String> {
    let mut steps = Vec::new();
    for block in blocks {
        let sides = [&block.early, &block.late];
        let [early, late] = sides.map(|words| !words.is_empty());
        let note = |words: String| format!("note {}: {words}", block.line);
        let motion = block.goes.map(|x| format!("to {x}"));
        // All words stand before the motion where one of them acts there.
        let all = || {
            let places = ["X", "G9", "G64", "F600", "L", "R0", "FMAX"];
            let skip = |word: &&str| places.iter().all(|own| !word.starts_with(own));
            let own: Vec<&str> = match block.waits {
                Some(_) => return block.early[0].clone(),
                None => block.text.split_whitespace().filter(skip).collect(),
            };
            own.join(" ")
        };
        match (early, late) {
            (true, true) => {
                steps.push(note(all()));
                steps.extend(block.waits.map(|seconds| format!("wait {seconds}")));
                steps.extend(motion);
                let written = block.text.split_whitespace();
                let own: Vec<&str> = written
                    .filter(|word| block.late.iter().any(|l| l == word))
                    .collect();
                steps.push(note(own.join(" ")));
            }
            (true, false) => {
                steps.push(note(all()));
                steps.extend(block.waits.map(|seconds| format!("wait {seconds}")));
                steps.extend(motion);
            }
            (false, true) => {
                steps.extend(motion);
                steps.push(note(all()));
            }
            (false, false) => steps.extend(motion),
        }
        if block.stops {
            steps.push("stop".to_owned());
        }
    }
    steps
}

/// Whether so many lines of a kind are named as notes.
fn names(made: &Made, kind: &str, count: usize) -> bool {
    match count {
        0 => !found(made, &format!("{kind}: ")),
        1 => found(made, &format!("{kind}: 1 line ")),
        count => found(made, &format!("{kind}: {count} lines ")),
    }
}

fn wanted_acts(blocks: &[Block]) -> Vec<String> {
    let mut wanted = Vec::new();
    for block in blocks {
        wanted.extend(block.acts[0].iter().cloned());
        wanted.extend(block.goes.map(|x| format!("to {x}")));
        wanted.extend(block.acts[1].iter().cloned());
    }
    wanted.push("M2".to_owned());
    wanted
}

/// What is wrong with a program in another language.
fn check(made: &Made, blocks: &[Block], into: MakeLanguage) {
    let written = text_of(made, 0);
    let count = |is: &dyn Fn(&&Block) -> bool| blocks.iter().filter(is).count();
    let (waits, stops) = (count(&|b| b.waits.is_some()), count(&|b| b.stops));
    match into {
        MakeLanguage::Gcode => assert_eq!(acts_of(&written), wanted_acts(blocks)),
        MakeLanguage::Krl | MakeLanguage::Rapid => {
            let mut steps = steps_of(&written, into);
            steps.retain(|step| !step.ends_with(": M30"));
            assert_eq!(steps, wanted_steps(blocks));
        }
        MakeLanguage::FanucLs => assert_eq!(written.matches("  PAUSE ;").count(), stops),
        MakeLanguage::Apt => {
            let is_stop = |line: &&str| matches!(*line, "STOP" | "OPSTOP");
            assert_eq!(written.lines().filter(is_stop).count(), stops);
        }
        _ => {}
    }
    let of_a_machine = matches!(into, MakeLanguage::Apt | MakeLanguage::Gcode);
    let lost = |kind: &str, own: usize, is_lost: bool| {
        assert!(
            names(made, kind, own * usize::from(is_lost)),
            "{kind} {own}: {:?}",
            made.findings
        );
    };
    lost("spindle", count(&|b| b.has[0]), !of_a_machine);
    lost("coolant", count(&|b| b.has[1]), !of_a_machine);
    lost("other statements", count(&|b| b.has[2]), true);
    lost("dwells", waits, into == MakeLanguage::Csv);
    lost("stops", stops, into == MakeLanguage::Csv);
}

#[test]
fn every_word_of_random_blocks_is_there_or_named() {
    let all = [
        MakeLanguage::Gcode,
        MakeLanguage::Apt,
        MakeLanguage::Krl,
        MakeLanguage::Rapid,
        MakeLanguage::FanucLs,
        MakeLanguage::Csv,
    ];
    for seed in 0..300 {
        for from in [Language::Siemens, Language::Heidenhain] {
            let mut chance = Chance::new(seed);
            let count = 3 + chance.below(30);
            let blocks = blocks(&mut chance, from, count);
            let text = program(from, &blocks);
            for into in all {
                // Where one of them fails, this says which.
                println!("{seed} {from:?} {into:?}\n{text}");
                check(&of_robot(from, &text, into), &blocks, into);
            }
        }
    }
}
