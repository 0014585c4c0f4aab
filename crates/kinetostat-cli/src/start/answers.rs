//! Answers about a cell, and the question that is next after them.

use std::path::{Path, PathBuf};

use kinetostat_model::schema::AxisName;

use crate::job::format::WeightWord;
use crate::job::target_word::RobotWord;
use crate::start::ask::Ask;
use crate::start::facts::Facts;
use crate::start::reading::{
    Cut, Engaged, Stated, above_zero, cut, cutter, engaged, frame_numbers, mass, numbers, one_of,
    statements, words_of, wrong,
};
use crate::start::robot::{Robot, Urdf};
use crate::ui::failure::Answer;

/// Answers so far.
#[derive(Clone, Default)]
pub(super) struct Answers {
    /// Folder of the files that are written.
    pub(super) folder: PathBuf,
    pub(super) urdf: Option<Urdf>,
    pub(super) robot: Option<Robot>,
    pub(super) program: Option<Facts>,
    /// Language in which the program is to be written; `Some(None)`: that of the program.
    pub(super) to: Option<Option<RobotWord>>,
    pub(super) numbers: Option<[u32; 2]>,
    /// Tools that the program does not state, in their order; of G-code its only one.
    pub(super) tools: Vec<Stated>,
    /// Statements of the controller that start the spindle, and that stop it.
    pub(super) spindle: Vec<Vec<String>>,
    pub(super) tool_axis: Option<String>,
    pub(super) mass_kg: Option<f64>,
    pub(super) part: Option<Stated>,
    pub(super) weight: Option<WeightWord>,
    pub(super) touch_off_mm: Option<[f64; 3]>,
    pub(super) cut: Option<Cut>,
    /// Diameter mm, teeth, helix deg.
    pub(super) cutter: Option<[f64; 3]>,
    pub(super) engaged: Option<Engaged>,
    pub(super) rpm: Option<f64>,
    pub(super) air_mm_per_s: Option<f64>,
    pub(super) tolerance_um: Option<f64>,
}

impl Answers {
    /// The next question; none when all is known.
    pub(super) fn next(&self) -> Option<Ask> {
        let Some(robot) = &self.robot else {
            return Some(self.urdf.as_ref().map_or(Ask::Robot, Urdf::next));
        };
        let Some(program) = &self.program else {
            return Some(Ask::Program);
        };
        let made = self.to.flatten().is_some();
        let is_robot = program.language.is_some();
        let weighs = robot.model.document.mechanism.gravity_m_per_s2.is_some();
        let material = matches!(self.cut, Some(Cut::Material(_)));
        let questions = [
            (Ask::To, !is_robot && self.to.is_none()),
            (
                Ask::Numbers,
                self.to.flatten() == Some(RobotWord::Ls) && self.numbers.is_none(),
            ),
            (
                Ask::SpindleStart,
                made && program.has_spindle && self.spindle.is_empty(),
            ),
            (
                Ask::SpindleStop,
                made && program.has_spindle && self.spindle.len() == 1,
            ),
            (Ask::Tool, self.tools.len() < program.tools_to_ask()),
            (
                Ask::ToolAxis,
                program.axis_is_open && self.tool_axis.is_none(),
            ),
            (Ask::Mass, weighs && self.mass_kg.is_none()),
            (Ask::Part, program.asks_for_part() && self.part.is_none()),
            (Ask::Weight, weighs && self.weight.is_none()),
            (
                Ask::TouchOff,
                self.weight == Some(WeightWord::TouchOff) && self.touch_off_mm.is_none(),
            ),
            (Ask::Cut, self.cut.is_none()),
            (Ask::Cutter, material && self.cutter.is_none()),
            (Ask::Engaged, material && self.engaged.is_none()),
            (
                Ask::Speed,
                material && !program.has_spindle && self.rpm.is_none(),
            ),
            (
                Ask::Air,
                program.hides_rapids() && self.air_mm_per_s.is_none(),
            ),
            (Ask::Tolerance, self.tolerance_um.is_none()),
        ];
        let mut open = questions.into_iter().filter(|(_, is_open)| *is_open);
        open.next().map(|(ask, _)| ask)
    }

    /// True if the job can be looked at: tools and part are known, and a cut is stated as a whole.
    pub(super) fn can_be_checked(&self) -> bool {
        let behind = [Ask::Weight, Ask::Cut, Ask::Air, Ask::Tolerance];
        self.next().is_none_or(|open| behind.contains(&open))
    }

    /// Takes an answer, if it is one; what was understood, where that is worth a line.
    pub(super) fn take(&mut self, ask: Ask, text: &str) -> Answer<Option<String>> {
        let text = text.trim();
        match ask {
            Ask::Robot => {
                if let Some(urdf) = Urdf::of(text)? {
                    let tip = urdf.tip.as_ref();
                    let said =
                        tip.map(|tip| format!("the tool is on '{tip}', the end of the chain"));
                    self.urdf = Some(urdf);
                    return Ok(said);
                }
                let robot = Robot::of(text, &self.folder)?;
                let said = robot.model.document.mechanism.description.clone();
                self.robot = Some(robot);
                return Ok(said);
            }
            Ask::Tip => {
                self.urdf = self
                    .urdf
                    .as_ref()
                    .map(|urdf| urdf.with_tip(text))
                    .transpose()?
            }
            Ask::FlangeAxis => {
                let axes = [("x", AxisName::X), ("y", AxisName::Y), ("z", AxisName::Z)];
                let axis = one_of(text, &axes)?;
                if let Some(urdf) = &mut self.urdf {
                    urdf.flange_z = Some(axis);
                }
            }
            Ask::JointStiffness => {
                let made = self
                    .urdf
                    .as_ref()
                    .map(|urdf| urdf.robot(text))
                    .transpose()?;
                let (robot, remarks) = made.unzip();
                self.robot = robot;
                return Ok(remarks.filter(|remarks| !remarks.is_empty()));
            }
            Ask::Program => {
                let facts = Facts::of(Path::new(text), self.robot.as_ref().map(|own| &own.model))?;
                let said = facts.words();
                self.program = Some(facts);
                return Ok(Some(said));
            }
            Ask::To => {
                let made = words_of().into_iter().map(|(word, own)| (word, Some(own)));
                let words: Vec<_> = std::iter::once(("g-code".to_owned(), None))
                    .chain(made)
                    .collect();
                self.to = Some(one_of(text, &words)?);
            }
            Ask::Numbers => self.numbers = Some(frame_numbers(text)?),
            Ask::SpindleStart | Ask::SpindleStop => self.spindle.push(statements(text)),
            Ask::Tool => {
                let length = numbers::<1>(text).ok();
                let along_z = length.map(|[z]| Stated {
                    position_mm: [0.0, 0.0, z],
                    orientation: None,
                });
                self.tools
                    .push(along_z.map_or_else(|| self.stated(text), Ok)?);
            }
            Ask::ToolAxis => {
                let axes = ["x", "y", "z", "-x", "-y", "-z"].map(|axis| (axis, axis));
                self.tool_axis = Some(one_of(text, &axes)?.to_owned());
            }
            Ask::Mass => self.mass_kg = Some(mass(text)?),
            Ask::Part => self.part = Some(self.stated(text)?),
            Ask::Weight => self.weight = Some(one_of(text, &words_of())?),
            Ask::TouchOff => self.touch_off_mm = Some(numbers(text)?),
            Ask::Cut => {
                let cut = cut(text)?;
                let is_gcode = self.program.as_ref().is_some_and(|p| p.language.is_none());
                if matches!(cut, Cut::Material(_)) && !is_gcode {
                    return Err(wrong(
                        "forces follow from the cut along G-code only: answer the force, or give the G-code from which this program was made",
                    ));
                }
                self.cut = Some(cut);
            }
            Ask::Cutter => self.cutter = Some(cutter(text)?),
            Ask::Engaged => self.engaged = Some(engaged(text)?),
            Ask::Speed => self.rpm = Some(above_zero(text)?),
            Ask::Air => self.air_mm_per_s = Some(above_zero(text)?),
            Ask::Tolerance => self.tolerance_um = Some(1e3 * above_zero(text)?),
        }
        Ok(None)
    }

    /// A place, with the angles of the robot that takes the program.
    fn stated(&self, text: &str) -> Answer<Stated> {
        let language = self.to.flatten().map(RobotWord::of_robot);
        let own = || self.program.as_ref()?.language;
        Stated::read(text, language.or_else(own))
    }
}
