//! FANUC TP programs as text: instructions, then the positions that they go to.
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4 "Program structure".

use nalgebra::{UnitQuaternion, Vector3};

use crate::making::events::EventAction;
use crate::making::names::{angles, coordinates, fixed, of_part, short};
use crate::making::step::{MadeMotion, Step, Way, parts};
use crate::making::template::Template;
use crate::model::orientation::OrientationText;

/// Characters of a remark.
const REMARK: usize = 32;

/// Default configuration of the arm: a TP program must state one.
pub(crate) const CONFIGURATION: &str = "N U T, 0, 0, 0";

/// The files of a program: the main one first.
pub(crate) fn files(
    steps: &[Step],
    name: &str,
    most: usize,
    template: &Template,
    made_by: &str,
) -> Vec<(String, Vec<u8>)> {
    let ranges = parts(steps, most);
    let mut files = Vec::with_capacity(ranges.len() + 1);
    let several = ranges.len() > 1;
    if several {
        let mut main = Writer::new(template, None);
        main.remark(made_by);
        for part in 0..ranges.len() {
            main.instruction(&format!("  CALL {} ", of_part(name, part)));
        }
        files.push(main.file(name));
    }
    let mut tool = None;
    for (part, range) in ranges.into_iter().enumerate() {
        let mut writer = Writer::new(template, tool);
        if !several {
            writer.remark(made_by);
        }
        writer.begin(part == 0);
        for step in &steps[range] {
            writer.step(step);
        }
        tool = writer.tool;
        files.push(writer.file(&match several {
            true => of_part(name, part),
            false => name.to_owned(),
        }));
    }
    files
}

struct Writer<'t> {
    template: &'t Template,
    tool: Option<u32>,
    instructions: String,
    lines: usize,
    positions: String,
    count: usize,
}

impl<'t> Writer<'t> {
    fn new(template: &'t Template, tool: Option<u32>) -> Self {
        Self {
            template,
            tool,
            instructions: String::new(),
            lines: 0,
            positions: String::new(),
            count: 0,
        }
    }

    fn file(self, name: &str) -> (String, Vec<u8>) {
        let text = format!(
            "/PROG  {name}\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"kinetostat\";\nLINE_COUNT\t= {};\nPROTECT\t\t= READ_WRITE;\n\
             DEFAULT_GROUP\t= 1,*,*,*,*;\nCONTROL_CODE\t= 00000000 00000000;\n/MN\n{}/POS\n{}/END\n",
            self.lines, self.instructions, self.positions
        );
        (
            format!("{}.ls", name.to_ascii_lowercase()),
            text.into_bytes(),
        )
    }

    fn instruction(&mut self, text: &str) {
        self.lines += 1;
        self.instructions += &format!("{:>4}:{text} ;\n", self.lines);
    }

    fn remark(&mut self, text: &str) {
        let characters: Vec<char> = text.chars().collect();
        for part in characters.chunks(REMARK) {
            let part: String = part.iter().collect();
            self.instruction(&format!("  !{}", part.trim_end()));
        }
    }

    fn tool_number(&self) -> u32 {
        let several = self
            .tool
            .and_then(|number| Some((number, self.template.tools.get(&number)?)));
        match several {
            Some((number, tool)) => tool.frame.number.unwrap_or(number),
            None => self.template.tool.frame.number.unwrap_or(1),
        }
    }

    fn base_number(&self) -> u32 {
        self.template.base.number.unwrap_or(1)
    }

    fn begin(&mut self, is_first: bool) {
        let (base, tool) = (self.base_number(), self.tool_number());
        self.instruction(&format!("  UFRAME_NUM={base}"));
        self.instruction(&format!("  UTOOL_NUM={tool}"));
        if let (true, Some(joints)) = (is_first, &self.template.start_joints_deg) {
            self.count += 1;
            let mut text = format!(
                "P[{}]{{\n   GP1:\n\tUF : {base}, UT : {tool},\t\n",
                self.count
            );
            let joints: Vec<String> = (joints.iter().enumerate())
                .map(|(axis, value)| format!("\tJ{}=   {} deg", axis + 1, fixed(*value, 6)))
                .collect();
            text += &joints.join(",\n");
            self.positions += &(text + "\n};\n");
            let percent = short(self.template.joint_speed_percent, 0);
            self.instruction(&format!("J P[{}] {percent}% FINE   ", self.count));
        }
    }

    /// Writes a position and says its number.
    fn position(
        &mut self,
        place: &Vector3<f64>,
        turn: &UnitQuaternion<f64>,
        stated: Option<&str>,
    ) -> usize {
        self.count += 1;
        let [x, y, z] = coordinates(place, self.template.position_decimals);
        let wpr = angles(turn, OrientationText::Wpr, self.template.angle_decimals);
        let configuration = self
            .template
            .configuration
            .as_deref()
            .or(stated)
            .unwrap_or(CONFIGURATION);
        self.positions += &format!(
            "P[{}]{{\n   GP1:\n\tUF : {}, UT : {},\t\tCONFIG : '{configuration}',\n\tX = {x:>12}  mm,\tY = {y:>12}  mm,\tZ = {z:>12}  mm,\n\
             \tW = {:>13} deg,\tP = {:>13} deg,\tR = {:>13} deg\n}};\n",
            self.count,
            self.base_number(),
            self.tool_number(),
            wpr[0],
            wpr[1],
            wpr[2]
        );
        self.count
    }

    fn step(&mut self, step: &Step) {
        match step {
            Step::Note(text) => self.remark(text),
            Step::Action(EventAction::Wait { seconds }) => {
                self.instruction(&format!("  WAIT {:>6}(sec)", fixed(*seconds, 2)))
            }
            Step::Action(EventAction::Stop | EventAction::OptionalStop) => {
                self.instruction("  PAUSE");
            }
            Step::Action(_) => {}
            Step::Statement(text) => {
                self.instruction(&format!("  {}", text.trim_end_matches([' ', ';'])))
            }
            Step::Tool(number) => {
                self.tool = Some(*number);
                let tool = self.tool_number();
                self.instruction(&format!("  UTOOL_NUM={tool}"));
            }
            Step::Motion(motion) => self.motion(motion),
        }
    }

    fn motion(&mut self, motion: &MadeMotion) {
        let turn = motion.orientation.unwrap_or_default();
        let zones = &self.template.zones;
        let percent = match motion.rapid {
            true => zones.rapids_percent,
            false => zones.feeds_percent,
        };
        let zone = match motion.exact || percent == 0.0 {
            true => "FINE".to_owned(),
            false => format!("CNT{}", fixed(percent, 0)),
        };
        let speed = speed_text(motion.speed_mm_per_s, self.template);
        match motion.way {
            Way::Joint => {
                let end = self.position(&motion.end, &turn, motion.end_configuration());
                let percent = short(self.template.joint_speed_percent, 0);
                self.instruction(&format!("J P[{end}] {percent}% {zone}   "));
            }
            Way::Circle {
                via,
                via_orientation,
            } => {
                let via = self.position(
                    &via,
                    &via_orientation.unwrap_or(turn),
                    motion.via_configuration(),
                );
                let end = self.position(&motion.end, &turn, motion.end_configuration());
                self.instruction(&format!(
                    "C P[{via}]    \n    :  P[{end}] {speed}mm/sec {zone}   "
                ));
            }
            _ => {
                let end = self.position(&motion.end, &turn, motion.end_configuration());
                self.instruction(&format!("L P[{end}] {speed}mm/sec {zone}   "));
            }
        }
    }
}

/// A speed in tenths of mm/s, never zero.
fn speed_text(mm_per_s: f64, template: &Template) -> String {
    let decimals = template.speed_decimals.unwrap_or(1);
    let text = short(mm_per_s, decimals);
    match text.parse() == Ok(0.0) {
        true => short(10_f64.powi(-(decimals as i32)), decimals),
        false => text,
    }
}
