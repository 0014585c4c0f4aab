//! Faults of a verified program.

use kinetostat_machining::FeatureResult;

use crate::verify::answer::VerifyAnswer;
use crate::verify::other_word::OtherWord;
use crate::verify::tilted::Tilted;

impl VerifyAnswer {
    /// Faults of the program, a sentence each.
    pub(crate) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        if !self.stable {
            faults.push(
                "THE MACHINE IS NOT STABLE under this load: do not run this program.".to_owned(),
            );
        }
        for uncut in &self.matched.uncut {
            let [first, last] = uncut.lines;
            let lines = match first == last {
                true => format!(
                    "LINE {first}{} OF THE ORIGINAL IS NOT CUT",
                    self.source(first)
                ),
                false => format!(
                    "LINES {first}{} TO {last}{} OF THE ORIGINAL ARE NOT CUT",
                    self.source(first),
                    self.source(last)
                ),
            };
            let length = kinetostat_machining::number::largest_length(uncut.length_mm);
            faults.push(format!("{lines} by this program: {length} of path."));
        }
        for cut in &self.matched.extra_cuts {
            let length = kinetostat_machining::number::largest_length(cut.length_mm);
            faults.push(format!(
                "LINE {} IS A MOVE AT FEED THAT THE ORIGINAL DOES NOT MAKE: {length} long.",
                cut.line
            ));
        }
        for rapid in &self.matched.rapids {
            let off = kinetostat_machining::number::largest_length(rapid.distance_mm);
            let of_original = match rapid.line_of_original {
                Some(line) => format!(
                    "from that of the original (line {line}{} there)",
                    self.source(line)
                ),
                None => "beside or along the cut, where the original has none".to_owned(),
            };
            faults.push(format!(
                "THE RAPID AT LINE {} GOES ELSEWHERE: up to {off} {of_original}.",
                rapid.line
            ));
        }
        faults.extend(self.faults_of_words());
        faults.extend(self.tilted.iter().map(Tilted::text));
        if let Some(m) = &self.missed {
            let (error, allowed) =
                kinetostat_machining::number::against(m.error_mm, self.allowed_mm);
            faults.push(format!(
                "THE TOLERANCE IS MISSED at line {} (line {}{} of the original): the tool is {error} off, more than the {allowed} that are allowed.",
                m.output_line,
                m.line,
                self.source(m.line)
            ));
        }
        faults.extend(self.features.iter().filter_map(FeatureResult::missed_text));
        faults
    }

    /// Feeds, spindles, tools, frames and statements of the program that are faults, a sentence each.
    pub(crate) fn faults_of_words(&self) -> Vec<String> {
        let words = self.other_words.iter();
        words.filter_map(OtherWord::fault_text).collect()
    }
}
