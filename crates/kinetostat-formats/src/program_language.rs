//! Facts and acts of a language: all that files outside its folder ask of it.

use kinetostat_program::SpindleChange;
use nalgebra::Vector3;

use crate::error::{ProgramError, WriteError};
use crate::file_form::FileForm;
use crate::flat_run::RefusedRun;
use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::parsed::Parsed;
use crate::model::program::{ACCELERATION, RobotProgram};
use crate::model::target::{Configuration, StatedArm};
use crate::options::{ReadOptions, WriteOptions};
use crate::table::StatementRow;
use crate::text::source::{FlatText, SourceFile};
use crate::writing::piece::Piece;

/// A file of a program that a language writes: its name and its bytes.
pub type WrittenFile = (String, Vec<u8>);

/// Advice where no block says how fast its motion is.
pub(crate) const SPEED_REMEDY_OF_BLOCKS: &str = "write an F above zero (with G95 the speed of the spindle, S with M3 or M4, too), or state unstated_feed_mm_per_s in the template";

/// A language of robots or machines. A method with a default has the answer that most languages give.
///
/// Code outside the folder of a language asks for what it needs to know here, and names no language.
pub trait ProgramLanguage: Sync {
    /// Name of the language in options, in small letters.
    fn word(&self) -> &'static str;

    /// Short name in sentences.
    fn name(&self) -> &'static str;

    /// Name in a list of languages.
    fn title(&self) -> &'static str;

    /// Endings of its files, in small letters, the usual one first.
    fn endings(&self) -> &'static [&'static str];

    /// Beginning of a comment that goes to the end of its line.
    fn comment(&self) -> &'static str;

    /// Each statement with what it is taken for.
    fn statements(&self) -> &'static [StatementRow];

    /// Description of the writer's changes, in sentences.
    fn written(&self) -> &'static str;

    /// Reads all that can be read of the files of a program.
    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed;

    /// Files of a program with pieces in place of its motions ([`crate::write()`]).
    ///
    /// # Errors
    /// A motion that cannot take its pieces, by file and line.
    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError>;

    /// Runs a program once and writes it flat ([`crate::expand`]); `None` where the reader follows what the language has.
    ///
    /// # Errors
    /// What the run refuses, with the text that it wrote all the same.
    fn expand(
        &self,
        _files: &[SourceFile],
        _options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        Ok(None)
    }

    /// True for a file of a program that stays beside its flat text.
    fn stays_beside_flat(&self, _file: &SourceFile) -> bool {
        false
    }

    /// Names of files of programs that a file may call, as often as they stand there.
    fn called_files(&self, _file: &SourceFile) -> Vec<String> {
        Vec::new()
    }

    /// Files that belong to one of a program, of those in its folder: the data of the same name, and what a robot's program calls.
    fn files_beside(&self, file: &SourceFile, folder: &[String]) -> Vec<String> {
        let stem = file.name().rsplit_once('.').map_or("", |(stem, _)| stem);
        let data = self.data_ending().map(|data| format!("{stem}.{data}"));
        let called = match self.is_of_robot() {
            true => self.called_files(file),
            false => Vec::new(),
        };
        let is_called = |own: &&String| called.iter().any(|name| name.eq_ignore_ascii_case(own));
        let data = data.filter(|name| folder.contains(name)).into_iter();
        data.chain(folder.iter().filter(is_called).cloned())
            .collect()
    }

    /// True where its reader knows lines that end with a carriage return alone.
    fn reads_all_line_ends(&self) -> bool {
        false
    }

    /// True where a rapid goes straight: robots move all joints in step.
    fn rapids_are_straight(&self) -> bool {
        false
    }

    /// Word in capitals that a file holds where its ending does not say enough; `None` where the ending says it.
    fn held_word(&self) -> Option<&'static str> {
        None
    }

    /// Words by which a file with another ending is known to be of this language, each with the ending that it is to have.
    fn own_words(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Endings of files with its programs in another form, which is not read, each with what to give in their place.
    fn unread_endings(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// True for the beginning of a file, in capitals, that has an ending of G-code and is of this language.
    fn is_beginning(&self, _beginning: &[u8]) -> bool {
        false
    }

    /// A file of it in sentences.
    fn file_title(&self) -> &'static str {
        self.name()
    }

    /// Endings that a written program may have, in small letters, the usual one first.
    fn written_endings(&self) -> &'static [&'static str] {
        self.endings()
    }

    /// Form of a file by its name and bytes, where the language has several.
    fn form(&self, _name: &str, _bytes: &[u8]) -> Option<FileForm> {
        None
    }

    /// Opening of a header line of a corrected program.
    fn header_opens(&self, _program: &[u8]) -> String {
        format!("{} ", self.comment())
    }

    /// End of a header line.
    fn header_closes(&self) -> &'static str {
        ""
    }

    /// Word in capitals of the line below which the header stands; `None`: the first line.
    fn header_below(&self) -> Option<&'static str> {
        None
    }

    /// Place of the header of a program, of which the place below its line is given.
    fn header_place(&self, _program: &[u8], below: usize) -> Option<usize> {
        Some(below)
    }

    /// True where the header is the mark of a corrected program alone, as lines are short.
    fn header_is_mark(&self) -> bool {
        false
    }

    /// Words of a line behind its number.
    fn behind_number<'l>(&self, line: &'l [u8]) -> &'l [u8] {
        line
    }

    /// A program to which lines were added, numbered again; `None` where its lines have no numbers.
    fn numbered_again(&self, _program: &[u8]) -> Option<Vec<u8>> {
        None
    }

    /// True for a language of robots.
    fn is_of_robot(&self) -> bool {
        true
    }

    /// True for programs that are run: with values that the caller states, and calls of what he says moves the tool.
    fn takes_values(&self) -> bool {
        self.is_of_robot()
    }

    /// True for a list of poses or joint values, which has no statements.
    fn is_list(&self) -> bool {
        false
    }

    /// True for programs in blocks of words, as controls of machines have them.
    fn is_in_blocks(&self) -> bool {
        false
    }

    /// True for programs that a controller loads by the name that they state.
    fn is_loaded(&self) -> bool {
        true
    }

    /// Ending of the file with the data of a program beside it, if it has one.
    fn data_ending(&self) -> Option<&'static str> {
        None
    }

    /// True where the files of a program can be joined in one.
    fn files_are_joined(&self) -> bool {
        false
    }

    /// True where files name frames that a file of the controller declares.
    fn needs_config(&self, _files: &[SourceFile]) -> bool {
        false
    }

    /// True where a switch of the control leaves out blocks behind a slash.
    fn has_slash_switch(&self) -> bool {
        false
    }

    /// Direction from the tool's tip to its holder, in axes of the tool, as is usual.
    fn usual_tool_axis(&self) -> Vector3<f64> {
        -Vector3::z()
    }

    /// True where the tool's axis is a choice of the cell, and only usual.
    fn tool_axis_is_open(&self) -> bool {
        false
    }

    /// True where targets state how the tool is turned about its own axis; other languages state the axis alone.
    fn states_turn(&self) -> bool {
        true
    }

    /// Numbers by which its controller shows orientations, if it is one of a robot.
    fn orientation_of_controller(&self) -> Option<OrientationText> {
        None
    }

    /// Shoulder, elbow and wrist of the arm as a configuration states them.
    fn stated_arm(&self, _configuration: &Configuration) -> StatedArm {
        StatedArm::default()
    }

    /// Words that state shoulder, elbow and wrist, where all are known.
    fn words_of_arm(&self, _arm: &StatedArm) -> Option<String> {
        None
    }

    /// True where the flag of the elbow is set when the forearm bends down from the upper arm (elbow up).
    fn elbow_flag_is_up(&self) -> bool {
        false
    }

    /// True where the flag of the wrist is the sign of axis 5 as the controller shows it.
    fn wrist_is_sign_of_axis_5(&self) -> bool {
        false
    }

    /// True where programs can switch off that the arm goes by the stated configurations.
    fn may_take_near_configurations(&self) -> bool {
        false
    }

    /// True for a program that does so.
    fn takes_near_configurations(&self, _program: &RobotProgram) -> bool {
        false
    }

    /// True where each pose states all external axes that there are.
    fn states_all_axes(&self) -> bool {
        false
    }

    /// Name of an external axis, counted from 0.
    fn name_of_external_axis(&self, axis: usize) -> String {
        format!("external axis {}", axis + 1)
    }

    /// Continuation of a sentence on what a call may do: statements that stay in force behind it, of which no motion says anything.
    fn modes_of_motions(&self) -> &'static str {
        ""
    }

    /// True where a comment with its origin may stand behind a line of a flat program.
    fn takes_origin(&self, line: &[u8]) -> bool {
        !line.is_empty() && !line.starts_with(b"%")
    }

    /// True where a rapid is a word of its own, and no speed.
    fn has_rapid_word(&self) -> bool {
        false
    }

    /// True for the text of a speed that is the word for a rapid.
    fn is_rapid(&self, _speed: &str) -> bool {
        false
    }

    /// Words for the direction of a tool that a motion leaves out; `None` where no direction has a meaning of its own.
    fn words_of_direction(&self) -> Option<&'static str> {
        None
    }

    /// True where statements of the spindle are part of the path that is read.
    fn spindle_is_in_path(&self) -> bool {
        false
    }

    /// Changes of the spindle that statements of a file make.
    fn spindle_changes(&self, _file: &SourceFile) -> Vec<SpindleChange> {
        Vec::new()
    }

    /// A line without the comment at its end, where one is told apart.
    fn code_of<'t>(&self, line: &'t str) -> &'t str {
        line
    }

    /// Words in capitals that set how motions run, in groups of which one is in force; where motions state it themselves, what a run says.
    fn modes(&self) -> &'static [&'static [&'static str]] {
        &[&[ACCELERATION]]
    }

    /// True where members of such a setting are settings of their own.
    fn modes_have_members(&self) -> bool {
        false
    }

    /// Beginnings of statements in capitals whose effect is in the places, frames, tools, speeds and zones of the motions.
    fn settings_in_motions(&self) -> &'static [&'static str] {
        &[]
    }

    /// Signs in a statement that declares a place, a frame or a tool by its value.
    fn sign_of_declaration(&self) -> Option<&'static str> {
        None
    }

    /// Law by which a motion of this word, in capitals, passes its places, where the language has several.
    fn law_of_motion(&self, _word: &str) -> Option<&'static str> {
        None
    }

    /// Words in the statement of a motion that state its zone, work object and tool; `None` where its other words are not compared.
    fn words_of_motion(&self, _motion: &Motion) -> Option<Vec<String>> {
        None
    }

    /// First words, in capitals, of statements that only structure a program.
    fn order_words(&self) -> &'static [&'static str] {
        &[]
    }

    /// Advice where the speed of a motion at feed is not known.
    fn speed_remedy(&self) -> &'static str {
        "write it as a number of mm/s (here it is a time, a register, or a name without a value), or state unstated_feed_mm_per_s in the template"
    }

    /// True for words of a line that state accelerations, overrides, or speeds of turning and of joint motions.
    fn states_dynamics(&self, _words: &[&str]) -> bool {
        false
    }

    /// True for the word of a motion in which the x of the tool swivels in a plane while the tool turns about it.
    fn swivels(&self, _word: &[u8]) -> bool {
        false
    }

    /// True where arcs are written about centres.
    fn has_centres(&self) -> bool {
        false
    }

    /// True where a corrected arc is written as a circle through a place; that of the arc may be one that is not written.
    fn writes_circles(&self, is_fixed: bool) -> bool {
        self.is_of_robot() && !is_fixed
    }

    /// True where a tool that turns goes on a great circle unless the program says otherwise.
    fn goes_on_great_circles(&self) -> bool {
        true
    }

    /// True where a place that states no direction of the tool keeps the one before.
    fn keeps_direction(&self) -> bool {
        false
    }

    /// Speed that controllers do not exceed, mm/s.
    fn most_speed_mm_per_s(&self) -> Option<f64> {
        None
    }

    /// True where tools and work objects have numbers, so that a name is that of a value.
    fn numbers_frames(&self) -> bool {
        false
    }

    /// Beginning of a comment behind a statement, where it is told apart from the statement.
    fn comment_behind_statement(&self) -> Option<&'static str> {
        None
    }

    /// True where a line holds several statements.
    fn has_several_statements_a_line(&self) -> bool {
        false
    }

    /// Beginnings of the lines that open and end the section with the instructions, in capitals.
    fn section(&self) -> Option<[&'static [u8]; 2]> {
        None
    }

    /// Statement of a line without what numbers and ends the line.
    fn statement_in<'t>(&self, line: &'t str) -> &'t str {
        line.trim()
    }

    /// Words that begin a routine, and those that end it.
    fn routines(&self) -> [&'static [&'static str]; 2] {
        [&[], &[]]
    }

    /// Name of the routine that a program begins with wherever it stands, in capitals.
    fn main_routine(&self) -> Option<&'static str> {
        None
    }

    /// True where what follows the name of a routine makes it a call.
    fn is_call(&self, behind: &str) -> bool {
        behind.starts_with('(')
    }

    /// Words of jumps.
    fn jumps(&self) -> &'static [&'static str] {
        &["GOTO", "JMP", "LBL", "SELECT", "INTERRUPT"]
    }

    /// True for words of a line that open a block that runs on a condition, or again.
    fn opens_block(&self, _words: &[String]) -> bool {
        false
    }

    /// Words that end the run of a program.
    fn ends_of_run(&self) -> &'static [&'static str] {
        &[]
    }
}

/// Names of files with an ending for the names that a program calls.
pub(crate) fn with_ending(names: Vec<String>, ending: &str) -> Vec<String> {
    let all = names.into_iter();
    all.map(|name| format!("{name}.{ending}")).collect()
}

/// A run that stops at what it refuses, and writes nothing then.
pub(crate) fn of_run(
    flat: Result<FlatText, Vec<ProgramError>>,
) -> Result<Option<FlatText>, RefusedRun> {
    flat.map(Some).map_err(RefusedRun::from)
}
