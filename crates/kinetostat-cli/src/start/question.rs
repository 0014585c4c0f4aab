//! The questions in words: what is asked, what an answer looks like, and what is taken for an empty one.

use kinetostat_cutting::Materials;
use kinetostat_model::preset_names;

use crate::start::answers::Answers;
use crate::start::ask::Ask;
use crate::start::reading::NONE;

/// A question.
pub(crate) struct Question {
    pub(crate) words: String,
    /// Shown when `?` is answered.
    pub(crate) help: String,
    /// Taken for an empty answer.
    pub(crate) usual: Option<&'static str>,
}

const POSE_HELP: &str = "X Y Z in mm, and behind them the orientation if it is not parallel: A B C of KUKA or W P R of FANUC in degrees, four numbers of a quaternion (w first, as ABB has it), or CONVENTION=numbers.";

impl Question {
    pub(super) fn of(ask: Ask, answers: &Answers) -> Self {
        let program = answers.program.as_ref();
        let (words, help, usual): (String, String, Option<&'static str>) = match ask {
            Ask::Robot => {
                let names: Vec<&str> = preset_names().iter().map(|preset| preset.name).collect();
                (
                    "Robot: a preset, a model file or a URDF".into(),
                    format!("Presets: {}. `kinetostat model list` describes them; their figures are those of a class of robots, not of yours.", names.join(", ")),
                    None,
                )
            }
            Ask::Tip => ("Link of the URDF that carries the tool".into(), "As in tool0 or flange.".into(), None),
            Ask::FlangeAxis => (
                "Axis of that link that points out of the flange: x, y or z".into(),
                "x of `flange` in ROS, z of `tool0`.".into(),
                Some("z"),
            ),
            Ask::JointStiffness => (
                "Stiffness of the joints, N m/rad, one number for all, or a table (CSV: name,value,unit)".into(),
                "A URDF says nothing of what bends. The answers that follow are as true as this number: `kinetostat plan-measurement` says where to pull, and `kinetostat identify` finds it from what was measured.".into(),
                None,
            ),
            Ask::Program => (
                "Program".into(),
                "G-code, or a program of a robot or a control (`kinetostat dialect list`). What stands beside it and is called is read with it.".into(),
                None,
            ),
            Ask::To => (
                "Language that the machine takes: g-code, krl, rapid or ls".into(),
                "A robot takes its own: krl of KUKA, rapid of ABB, ls of FANUC. The program is written in it.".into(),
                Some("g-code"),
            ),
            Ask::Numbers => (
                "Numbers of the user frame and the tool frame at the controller".into(),
                "As in 3 2 for UF : 3 and UT : 2.".into(),
                Some("1 1"),
            ),
            Ask::SpindleStart => (
                "Statements by which this controller starts the spindle, {rpm} for its speed; none if something else does".into(),
                "They stand where the program says M3. Several are divided by |, as in $ANOUT[1]={rpm}/24000.0 | $OUT[12]=TRUE.".into(),
                Some(NONE),
            ),
            Ask::SpindleStop => (
                "Statements that stop it".into(),
                "They stand where the program says M5, as in $OUT[12]=FALSE.".into(),
                Some(NONE),
            ),
            Ask::Tool => {
                let named = program.and_then(|p| p.tools.get(answers.tools.len()));
                let which = match (named, answers.to.flatten()) {
                    (Some(name), _) => format!("{name}, which the program does not state"),
                    // The cell states how the tool stands in the part: z into it.
                    (None, Some(_)) => "the tool, z of its frame out of the spindle".to_owned(),
                    (None, None) => "the tool".to_owned(),
                };
                (
                    format!("Tip of {which}, in axes of the flange: X Y Z in mm, or its length along z"),
                    POSE_HELP.into(),
                    None,
                )
            }
            Ask::ToolAxis => (
                "Axis of the tool's frame that points from its tip to the spindle: x, -x, y, -y, z or -z".into(),
                "At KUKA the tool's x often points out of the spindle: then it is -x.".into(),
                None,
            ),
            Ask::Mass => (
                "Mass of spindle and tool on the flange, kg; 0 if the model has it".into(),
                "Its weight bends the arm. The centre is taken halfway to the tip; centre_of_mass_mm under [tool] says better.".into(),
                None,
            ),
            Ask::Part => {
                let work_object = program.and_then(|p| p.work_object.as_deref());
                let which = work_object.map_or_else(|| "program's zero".to_owned(), |name| format!("work object {name}"));
                (format!("Place of the {which} in the robot's base: X Y Z in mm"), POSE_HELP.into(), None)
            }
            Ask::Weight => (
                "How that place was found: touch-off, all or none".into(),
                "touch-off: this robot touched the part, hanging as it hangs while it cuts, so that its own sag is in the numbers. all: it was measured without this robot. none: the controller corrects the weight.".into(),
                None,
            ),
            Ask::TouchOff => (
                "Where it touched, in coordinates of the program: X Y Z in mm".into(),
                "The weight counts as zero there; what is corrected is how the sag changes from there.".into(),
                Some("0 0 0"),
            ),
            Ask::Cut if program.is_some_and(|p| p.language.is_some()) => (
                "Cutting force in N: to the right of the feed, along it, along z; or none".into(),
                "As in 300 -100 -50. `kinetostat force` computes it from material, tool and cut.".into(),
                None,
            ),
            Ask::Cut => {
                let materials = Materials::library();
                let names: Vec<&str> = materials.iter().map(|material| material.name.as_str()).collect();
                (
                    "Material, or the cutting force itself in N: to the right of the feed, along it, along z; or none".into(),
                    format!("As in 300 -100 -50. Materials: {}.", names.join(", ")),
                    None,
                )
            }
            Ask::Cutter => ("End mill: diameter in mm, number of teeth, helix in deg".into(), "As in 12 4 38.".into(), None),
            Ask::Engaged => (
                "Block before the cut, two corners in coordinates of the program; or width and depth of the cut in mm and the side of the feed on which the part is".into(),
                "As in 0 0 -20 200 100 0, or 4 2 right.".into(),
                None,
            ),
            Ask::Speed => ("Speed of the spindle, 1/min, which turns clockwise".into(), "The program does not state it.".into(), None),
            Ask::Air => (
                "Speed from which on a straight motion is in air, mm/s".into(),
                "A robot's program does not say which motions cut. Joint motions never do.".into(),
                None,
            ),
            Ask::Tolerance => ("Tolerance of the path, mm".into(), "What the written program may leave, on top of nothing: the figures of the model have errors of their own.".into(), Some("0.05")),
        };
        Self { words, help, usual }
    }
}
