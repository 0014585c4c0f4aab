//! The table of short texts that each language fills.

use kinetostat_machining::{ArmConfiguration, LimitEnd};

use crate::paper::language::FigureWords;

/// Short texts. In curly brackets stands what is put in.
pub(crate) struct Words {
    pub(crate) figures: FigureWords,
    /// Kinds of papers.
    pub(crate) kind_compensated: &'static str,
    pub(crate) kind_analysed: &'static str,
    pub(crate) kind_verified: &'static str,
    pub(crate) title: &'static str,
    pub(crate) page_of: &'static str,
    pub(crate) made_by: &'static str,
    /// Note on text in English inside a paper of another language; empty in English.
    pub(crate) quoted: &'static str,
    pub(crate) not_stated: &'static str,
    pub(crate) none: &'static str,
    pub(crate) yes_no: [&'static str; 2],
    /// Words of the verdict.
    pub(crate) good: &'static str,
    pub(crate) unchanged: &'static str,
    pub(crate) analysis: &'static str,
    pub(crate) attention: &'static str,
    pub(crate) stop: &'static str,
    pub(crate) verified: &'static str,
    pub(crate) missed: &'static str,
    /// Verdict on a verified program that keeps its tolerance and has other faults.
    pub(crate) not_verified: &'static str,
    pub(crate) model_only: &'static str,
    pub(crate) read_back: &'static str,
    /// Heads of sections.
    pub(crate) head_results: &'static str,
    pub(crate) head_features: &'static str,
    pub(crate) head_worst: &'static str,
    pub(crate) head_drives: &'static str,
    pub(crate) head_cut: &'static str,
    pub(crate) head_left: &'static str,
    pub(crate) head_warnings: &'static str,
    pub(crate) head_inputs: &'static str,
    pub(crate) head_files: &'static str,
    pub(crate) head_signatures: &'static str,
    /// Facts of what was asked.
    pub(crate) date: &'static str,
    pub(crate) program: &'static str,
    pub(crate) original: &'static str,
    pub(crate) part_number: &'static str,
    pub(crate) revision: &'static str,
    pub(crate) machine: &'static str,
    pub(crate) model_from: &'static str,
    pub(crate) deviations: &'static str,
    pub(crate) stiffnesses: &'static str,
    pub(crate) load: &'static str,
    pub(crate) material: &'static str,
    pub(crate) no_material: &'static str,
    pub(crate) placement: &'static str,
    pub(crate) tool: &'static str,
    pub(crate) orientation: &'static str,
    pub(crate) path: &'static str,
    pub(crate) flat: &'static str,
    pub(crate) blocks_read: &'static str,
    pub(crate) blocks_written: &'static str,
    pub(crate) bytes: &'static str,
    pub(crate) tolerance_path: &'static str,
    pub(crate) tolerance_chords: &'static str,
    pub(crate) decimals: &'static str,
    /// Figures.
    pub(crate) figure: &'static str,
    pub(crate) before: &'static str,
    pub(crate) after: &'static str,
    pub(crate) of_original: &'static str,
    pub(crate) of_verified: &'static str,
    pub(crate) largest_error: &'static str,
    pub(crate) rms_error: &'static str,
    pub(crate) allowed_in_all: &'static str,
    pub(crate) held: &'static str,
    pub(crate) rounding: &'static str,
    pub(crate) largest_correction: &'static str,
    pub(crate) tilt: &'static str,
    pub(crate) stiffness: &'static str,
    pub(crate) buckling: &'static str,
    pub(crate) no_buckling: &'static str,
    pub(crate) speed: &'static str,
    pub(crate) blocks_per_second: &'static str,
    pub(crate) points: &'static str,
    pub(crate) stable: &'static str,
    /// Features.
    pub(crate) feature: &'static str,
    pub(crate) lines: &'static str,
    pub(crate) lines_to: &'static str,
    pub(crate) allowed: &'static str,
    pub(crate) verdict: &'static str,
    pub(crate) kept: &'static str,
    pub(crate) missed_here: &'static str,
    pub(crate) nothing_cut: &'static str,
    /// Worst lines.
    /// Pictures: what they show, their axes and lines.
    pub(crate) picture_along: &'static str,
    pub(crate) picture_above: &'static str,
    /// The machine at `{line}`.
    pub(crate) picture_machine: &'static str,
    pub(crate) along_path: &'static str,
    pub(crate) distance: &'static str,
    pub(crate) programmed: &'static str,
    pub(crate) displaced: &'static str,
    pub(crate) worst_note: &'static str,
    pub(crate) worst_note_verified: &'static str,
    pub(crate) worst_after_note: &'static str,
    pub(crate) line: &'static str,
    pub(crate) line_written: &'static str,
    pub(crate) line_from: &'static str,
    /// Drives.
    pub(crate) drive: &'static str,
    pub(crate) largest_force: &'static str,
    pub(crate) rating: &'static str,
    pub(crate) share: &'static str,
    pub(crate) correction: &'static str,
    pub(crate) range: &'static str,
    pub(crate) limits: &'static str,
    pub(crate) no_ratings: &'static str,
    pub(crate) nearest_limit: &'static str,
    pub(crate) nearest_limit_text: &'static str,
    pub(crate) lower: &'static str,
    pub(crate) upper: &'static str,
    pub(crate) most_loaded: &'static str,
    pub(crate) most_loaded_text: &'static str,
    pub(crate) configuration: &'static str,
    pub(crate) configuration_changes: &'static str,
    pub(crate) shoulder: [&'static str; 2],
    pub(crate) elbow: [&'static str; 2],
    pub(crate) wrist: [&'static str; 2],
    /// The cut.
    pub(crate) cut_force: &'static str,
    pub(crate) cut_torque: &'static str,
    pub(crate) cut_share: &'static str,
    pub(crate) cut_power: &'static str,
    pub(crate) cut_depth: &'static str,
    pub(crate) cut_spread: &'static str,
    pub(crate) cut_spindle: &'static str,
    /// Chatter.
    pub(crate) head_chatter: &'static str,
    pub(crate) chatter_unjudged: &'static str,
    pub(crate) chatter_none: &'static str,
    pub(crate) chatter_without: &'static str,
    pub(crate) chatter_some: &'static str,
    /// Speed, depth, stable depth, frequency, stable speed.
    pub(crate) chatter_columns: [&'static str; 5],
    pub(crate) chatter_nearest: &'static str,
    pub(crate) chatter_nearest_text: &'static str,
    /// Addition if the limit lies within the spread of the force.
    pub(crate) chatter_spread_text: &'static str,
    pub(crate) shaken: &'static str,
    pub(crate) shaken_text: &'static str,
    pub(crate) wall: &'static str,
    pub(crate) wall_text: &'static str,
    /// Sides of a wall error: too deep, and left standing.
    pub(crate) wall_sides: [&'static str; 2],
    pub(crate) chatter_note: &'static str,
    /// Effects that figures do not cover.
    pub(crate) not_covered: &'static str,
    pub(crate) not_covered_beside_chatter: &'static str,
    pub(crate) more_warnings: &'static str,
    pub(crate) more_features: &'static str,
    /// Files.
    pub(crate) file_what: &'static str,
    pub(crate) file_name: &'static str,
    pub(crate) file_program: &'static str,
    pub(crate) file_model: &'static str,
    pub(crate) file_job: &'static str,
    pub(crate) file_material: &'static str,
    pub(crate) file_written: &'static str,
    pub(crate) file_verified: &'static str,
    /// Signatures: who, then what is written.
    pub(crate) signed_by: [&'static str; 3],
    pub(crate) name_and_date: &'static str,
    pub(crate) signature: &'static str,
    /// Words of `verify` on uncut parts of the original, of one line and of several.
    pub(crate) uncut: [&'static str; 2],
    /// A rapid that goes elsewhere: `{line}`, `{length}`.
    pub(crate) rapid_elsewhere: &'static str,
    /// A move at feed that the original does not make: `{line}`, `{length}`.
    pub(crate) extra_cut: &'static str,
    /// Feed, spindle, tool or frame that differs from the original: `{line}`.
    pub(crate) other_word: &'static str,
}

impl Words {
    /// An end of a joint's range.
    pub(crate) fn end(&self, end: LimitEnd) -> &'static str {
        match end {
            LimitEnd::Lower => self.lower,
            LimitEnd::Upper => self.upper,
        }
    }

    /// Configuration of an arm.
    pub(crate) fn arm(&self, arm: &ArmConfiguration) -> String {
        let bit = |bit: u8| usize::from(arm.number & bit != 0);
        format!(
            "{}, {}, {}",
            self.shoulder[bit(1)],
            self.elbow[bit(2)],
            self.wrist[bit(4)]
        )
    }

    /// Kind of a file: some words are those of this table, others stay as they are.
    pub(crate) fn file(&self, what: &str) -> String {
        match what {
            "program" => self.file_program,
            "model" => self.file_model,
            "job" => self.file_job,
            "material" => self.file_material,
            "written program" => self.file_written,
            "verified program" => self.file_verified,
            other => other,
        }
        .to_owned()
    }
}

/// A text with what stands in it in curly brackets put in.
pub(crate) fn fill(text: &str, values: &[(&str, &str)]) -> String {
    // Proceeds from the left, so that inserted text is never searched again.
    let mut out = String::with_capacity(text.len() + 32);
    let mut rest = text;
    while let Some(start) = rest.find('{') {
        let Some(length) = rest[start..].find('}') else {
            break;
        };
        out.push_str(&rest[..start]);
        let name = &rest[start + 1..start + length];
        match values.iter().find(|(key, _)| *key == name) {
            Some((_, value)) => out.push_str(value),
            None => out.push_str(&rest[start..=start + length]),
        }
        rest = &rest[start + length + 1..];
    }
    out.push_str(rest);
    out
}
