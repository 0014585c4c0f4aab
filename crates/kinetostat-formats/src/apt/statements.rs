//! Effect of each statement.

use crate::apt::file_reader::{POINTS, Reader};
use crate::apt::lines::Statement;
use crate::apt::numbers::{Argument, arguments_of};
use crate::apt::spindle::spindle_of;
use crate::apt::state::{feed_of, system_of};
use crate::apt::table::row;
use crate::options::CutterCompensation;
use crate::table::Treatment;

impl Reader<'_, '_> {
    pub fn statement(&mut self, statement: &Statement) {
        let span = &statement.span;
        let word = self.file.part(&statement.word).to_ascii_uppercase();
        if statement.assigns {
            // Geometry and numbers move nothing; what drives along them is refused.
            return;
        }
        let is_motion = matches!(
            &word[..],
            b"GOTO" | b"PAINT" | b"FEDRAT" | b"SPINDL" | b"COOLNT" | b"PPRINT"
        );
        if !is_motion {
            self.end_circle();
        }
        let understood = word == b"CYCLE"
            || row(&word).is_some_and(|row| row.treatment == Treatment::Understood);
        if understood
            && !statement.slash
            && !statement.arguments.is_empty()
            && !matches!(&word[..], b"TLON" | b"SPINDL")
        {
            let remedy = "write it as WORD/arguments";
            self.state.place = None;
            return self.fault(span, "no slash stands behind the word", remedy);
        }
        match &word[..] {
            b"GOTO" => self.goto(statement),
            b"GODLTA" => self.step(statement),
            b"GOHOME" => self.home(statement),
            b"FROM" => self.from(statement),
            b"RAPID" => self.state.rapid = Some(span.clone()),
            b"FEDRAT" => match feed_of(self.file, statement, self.unit_mm) {
                Some(feed) => (self.state.feed, self.state.mm_per_turn) = feed,
                None => self.fault(span, "the feed has no number", "state it: FEDRAT/600,MMPM"),
            },
            b"SPINDL" => self.state.spindle = spindle_of(self.file, statement, self.state.spindle),
            b"CIRCLE" => self.circle(statement),
            b"FINI" | b"END" if statement.arguments.is_empty() => self.state.has_ended = true,
            b"TLON" => {
                let reason = "the end of the arc is where it meets a line, which is not computed";
                self.unknown(statement, reason);
            }
            b"CYCLE" => {
                let first = self.first_word(statement);
                self.state.in_cycle = !matches!(&first[..], b"OFF" | b"INIT");
            }
            b"CUTCOM" | b"TLCOMP" => self.compensation(statement),
            b"TLAXIS" => match self.numbers(statement) {
                Some(numbers) => self.axis(span, &numbers),
                None => self.fault(span, "the axis is not three numbers", POINTS),
            },
            b"MSYS" => {
                let numbers = self.numbers(statement).unwrap_or_default();
                let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
                match system_of(&values, self.unit_mm) {
                    Some(system) => {
                        self.state.system = Some(system);
                        // The following positions are in other axes.
                        self.state.place = None;
                    }
                    None => self.fault(
                        span,
                        "MSYS is not an origin and two axes at right angles",
                        "state nine numbers",
                    ),
                }
            }
            b"TRNTYP" if self.first_word(statement) != b"WORLD" => self.fault(
                span,
                "the places that follow are in other axes than the part's",
                "let the CAM system write them in the part's axes (TRNTYP/WORLD)",
            ),
            b"LOAD" | b"LOADTL" | b"TOOLNO" | b"TOOL PATH" => self.tool(statement, &word),
            // To zero, where all other turns are refused, it turns nothing.
            b"ROTABL" if self.is_at_zero(statement) => {}
            b"UNIT" | b"UNITS"
                if (self.program.motions.last()).is_some_and(|last| last.file == self.index) =>
            {
                self.fault(
                    span,
                    "the unit is stated behind a motion",
                    "state it before",
                );
            }
            _ => match row(&word).map(|row| row.treatment) {
                Some(Treatment::Refused { reason, remedy }) => self.fault(span, reason, remedy),
                Some(_) => {}
                None if word.starts_with(b"CSI_") => {}
                None => self.fault(
                    span,
                    "the word is not known, and may move the tool",
                    "take the statement out, or make it a comment ($$)",
                ),
            },
        }
    }

    /// Whether all numbers of a statement are zero, and there are some.
    fn is_at_zero(&self, statement: &Statement) -> bool {
        let arguments = arguments_of(self.file.bytes(), &statement.arguments);
        let mut numbers = arguments.iter().filter_map(Argument::number).peekable();
        numbers.peek().is_some() && numbers.all(|number| number.value == 0.0)
    }

    fn compensation(&mut self, statement: &Statement) {
        let on = self.first_word(statement) != b"OFF";
        if on && self.program.options.cutter_compensation == CutterCompensation::Refused {
            self.fault(
                &statement.span,
                "the controller moves the path aside by the tool's radius",
                "if the places are those of the tool's centre, say so (cutter_compensation = \"centre_path\" under [robot] in a job file)",
            );
        }
    }

    fn tool(&mut self, statement: &Statement, word: &[u8]) {
        let arguments = arguments_of(self.file.bytes(), &statement.arguments);
        let last = arguments.last();
        let number = arguments.iter().find_map(Argument::number);
        let name = match (word, last, number) {
            (b"TOOL PATH", Some(Argument::Word(name)), _) => {
                String::from_utf8_lossy(self.file.part(name)).into_owned()
            }
            (_, _, Some(number)) => format!("{}", number.value),
            _ => return,
        };
        self.state.tool = format!("TOOL:{name}");
    }
}
