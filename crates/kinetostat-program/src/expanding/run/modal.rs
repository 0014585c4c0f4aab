//! M70 to M73: modes are saved, and put back by the words that LinuxCNC writes for them.
//!
//! Takes the words of the blocks that are run; gives, for two states, the blocks that lead from one to the other. The motion
//! mode is not put back. Source: LinuxCNC, `docs/src/gcode/m-code.adoc`, M70 to M73; the order of the words, the digits of F
//! (one) and S (none) are those of its interpreter (`docs/linuxcnc.md`, section 12).

use crate::path::moves::FeedMode;
use crate::path::spindle::SpindleRotation;
use crate::reading::interpreting::Interpreter;
use crate::reading::options::Units;
use crate::text::lex::{Spanned, Token};
use crate::text::tenths;

/// Modal functions that the path does not know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Functions {
    speed: f64,
    constant_surface: bool,
    mist: bool,
    flood: bool,
    feed_override: bool,
    speed_override: bool,
    adaptive_feed: bool,
    feed_hold: bool,
    /// G61, G61.1, G64 with P and Q; `None` before the program names it.
    path_mode: Option<(u32, Option<f64>, Option<f64>)>,
    /// True if G92 is in force; `None` before the program states it.
    shifted: Option<bool>,
}

impl Default for Functions {
    fn default() -> Self {
        Self {
            speed: 0.0,
            constant_surface: false,
            mist: false,
            flood: false,
            feed_override: true,
            speed_override: true,
            adaptive_feed: false,
            feed_hold: true,
            path_mode: None,
            shifted: None,
        }
    }
}

impl Functions {
    /// Takes the words of a block.
    pub fn note(&mut self, tokens: &[Spanned]) {
        let words = || {
            tokens.iter().filter_map(|spanned| match spanned.token {
                Token::Word { letter, value, .. } => Some((letter, value)),
                _ => None,
            })
        };
        let of = |wanted: u8| {
            let mut own = words().filter(|(letter, _)| *letter == wanted);
            own.next().map(|(_, value)| value)
        };
        let is_on = of(b'P').is_none_or(|p| p != 0.0);
        let (mut is_time, mut is_angle) = (false, false);
        for (letter, value) in words() {
            match (letter, tenths(value)) {
                (b'G', 40) => is_time = of(b'P').is_none(),
                (b'G', code @ (610 | 611)) => self.path_mode = Some((code, None, None)),
                (b'G', 640) => self.path_mode = Some((640, of(b'P'), of(b'Q'))),
                (b'G', code @ (960 | 970)) => self.constant_surface = code == 960,
                (b'G', 920 | 923) => self.shifted = Some(true),
                (b'G', 921 | 922) => self.shifted = Some(false),
                (b'M', 190) => is_angle = true,
                (b'M', 70) => self.mist = true,
                (b'M', 80) => self.flood = true,
                (b'M', 90 | 20 | 300) => (self.mist, self.flood) = (false, false),
                (b'M', code @ (480 | 490)) => {
                    (self.feed_override, self.speed_override) = (code == 480, code == 480);
                }
                (b'M', 500) => self.feed_override = is_on,
                (b'M', 510) => self.speed_override = is_on,
                (b'M', 520) => self.adaptive_feed = is_on,
                (b'M', 530) => self.feed_hold = is_on,
                _ => {}
            }
        }
        if let (Some(speed), false) = (of(b'S'), is_time || is_angle) {
            self.speed = speed;
        }
    }

    /// True if an offset of G92 is in force.
    pub fn is_shifted(&self) -> bool {
        self.shifted == Some(true)
    }

    fn overrides(&self) -> &'static str {
        match (self.feed_override, self.speed_override) {
            (true, true) => "M48",
            (true, false) => "M50",
            (false, true) => "M51",
            (false, false) => "M49",
        }
    }

    /// The words of mist and flood, as LinuxCNC lists them.
    fn coolant(&self) -> [Option<&'static str>; 2] {
        let mist = match (self.mist, self.flood) {
            (true, _) => Some("M7"),
            (false, true) => None,
            (false, false) => Some("M9"),
        };
        [mist, self.flood.then_some("M8")]
    }
}

/// Modes as M70 and M73 save them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Saved {
    functions: Functions,
    units: Option<Units>,
    plane: [usize; 3],
    incremental: bool,
    centres_are_places: bool,
    feed_mode: FeedMode,
    /// Feed in units of the program.
    feed: Option<f64>,
    system: usize,
    tool_length: bool,
    to_level: bool,
    rotation: SpindleRotation,
}

/// Modes that a subprogram, or the program, has saved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Context {
    pub saved: Saved,
    /// M73: put back at the end of the subprogram.
    pub at_return: bool,
}

impl Saved {
    pub fn of(state: &Interpreter<'_>, functions: Functions) -> Self {
        Self {
            functions,
            units: state.units(),
            plane: state.plane_axes(),
            incremental: state.is_incremental(),
            centres_are_places: state.centres_are_places(),
            feed_mode: state.feed_mode(),
            feed: state.feed_in_units(),
            system: state.work_system(),
            tool_length: state.has_tool_length(),
            to_level: state.retracts_to_level().unwrap_or(true),
            rotation: state.spindle_rotation(),
        }
    }

    /// True if LinuxCNC restores a feed of zero: there was no F, or G94 and G95 take it away after G93.
    pub fn takes_the_feed_away(&self, now: &Saved) -> bool {
        let behind_inverse =
            now.feed_mode == FeedMode::InverseTime && self.feed_mode != now.feed_mode;
        self.feed.is_none() && now.feed.is_some() || behind_inverse
    }

    /// The block that puts back the units; it goes before the others.
    pub fn units_word(&self, now: &Saved) -> Result<Option<&'static str>, &'static str> {
        match (self.units, now.units) {
            (before, after) if before == after => Ok(None),
            (Some(Units::Inches), _) => Ok(Some("G20")),
            (Some(Units::Millimetres), _) => Ok(Some("G21")),
            (None, _) => Err("the units before M70 or M73 were not named"),
        }
    }

    /// The blocks that lead from the state now, its units put back, to the saved one.
    pub fn blocks(&self, now: &Saved) -> Result<Vec<String>, &'static str> {
        let mut words: Vec<String> = Vec::new();
        let mode_differs = self.feed_mode != now.feed_mode;
        let is_inverse =
            [self, now].map(|one| one.feed_mode == FeedMode::InverseTime) != [false; 2];
        let differs = self.feed != now.feed || mode_differs;
        if let Some(feed) = self.feed.filter(|_| differs && !is_inverse) {
            words.push(format!("F{feed:.1}"));
        }
        let (own, other) = (&self.functions, &now.functions);
        if own.speed != other.speed {
            words.push(format!("S{:.0}", own.speed));
        }
        let mut code = |differs: bool, word: &str| {
            if differs {
                words.push(word.to_owned());
            }
        };
        let plane = ["G19", "G18", "G17"][self.plane[2]];
        code(self.plane != now.plane, plane);
        code(
            self.incremental != now.incremental,
            either(self.incremental, ["G91", "G90"]),
        );
        let feed_mode = match self.feed_mode {
            FeedMode::InverseTime => "G93",
            FeedMode::PerMinute => "G94",
            FeedMode::PerRevolution => "G95",
        };
        code(mode_differs, feed_mode);
        let system = SYSTEMS.get(self.system).copied();
        let system =
            system.ok_or("the work coordinate system before M70 or M73 is none of G54 to G59.3")?;
        code(self.system != now.system, system);
        code(
            self.tool_length != now.tool_length,
            either(self.tool_length, ["G43", "G49"]),
        );
        code(
            self.to_level != now.to_level,
            either(self.to_level, ["G99", "G98"]),
        );
        let path_differs = own.path_mode != other.path_mode;
        if path_differs && own.path_mode.is_none() {
            return Err("the path mode (G61, G64) before M70 or M73 was not named");
        }
        match own.path_mode {
            Some((610, ..)) => code(path_differs, "G61"),
            Some((611, ..)) => code(path_differs, "G61.1"),
            _ => {}
        }
        code(
            own.constant_surface != other.constant_surface,
            either(own.constant_surface, ["G96", "G97"]),
        );
        code(
            self.centres_are_places != now.centres_are_places,
            either(self.centres_are_places, ["G90.1", "G91.1"]),
        );
        match (own.shifted, other.shifted) {
            (None, Some(_)) => {
                return Err(
                    "whether an offset of G92 was in force before M70 or M73 is not in the program",
                );
            }
            (Some(own), other) => code(Some(own) != other, either(own, ["G92.3", "G92.2"])),
            (None, None) => {}
        }
        if let (Some((640, p, q)), true) = (own.path_mode, path_differs) {
            let of = |letter: char, value: Option<f64>| {
                value.map_or(String::new(), |value| format!(" {letter}{value:.6}"))
            };
            words.push(format!("G64{}{}", of('P', p), of('Q', q)));
        }
        let mut blocks = vec![words.join(" ")];
        blocks.extend(self.functions_from(now));
        blocks.retain(|block| !block.is_empty());
        Ok(blocks)
    }

    fn functions_from(&self, now: &Saved) -> Vec<String> {
        let (own, other) = (&self.functions, &now.functions);
        let turning = |rotation: SpindleRotation| match rotation {
            SpindleRotation::Clockwise => "M3",
            SpindleRotation::CounterClockwise => "M4",
            SpindleRotation::Stopped => "M5",
        };
        let on = |is: bool, word: &'static str| is.then_some(word);
        let [mist, flood] = own.coolant();
        let [mist_now, flood_now] = other.coolant();
        let pairs = [
            (Some(turning(self.rotation)), Some(turning(now.rotation))),
            (mist, mist_now),
            (flood, flood_now),
            (Some(own.overrides()), Some(other.overrides())),
            (on(own.adaptive_feed, "M52"), on(other.adaptive_feed, "M52")),
            (on(own.feed_hold, "M53"), on(other.feed_hold, "M53")),
        ];
        let differing = pairs.into_iter().filter(|(own, other)| own != other);
        differing
            .filter_map(|(own, _)| own.map(str::to_owned))
            .collect()
    }
}

const SYSTEMS: [&str; 9] = [
    "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3",
];

fn either(first: bool, words: [&'static str; 2]) -> &'static str {
    match first {
        true => words[0],
        false => words[1],
    }
}
