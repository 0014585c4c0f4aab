//! Programs in KRL, with their points in line: no data list is needed.
//!
//! Source: KUKA System Software 8.x, Operating and Programming Instructions for System Integrators.

use nalgebra::{UnitQuaternion, Vector3};

use crate::making::events::EventAction;
use crate::making::names::{angles, coordinates, of_part, short};
use crate::making::step::{MadeMotion, Step, Way, parts};
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::model::orientation::OrientationText;

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
    if ranges.len() > 1 {
        let mut main = format!("&ACCESS RVP\nDEF {name}( )\n; {made_by}\nBAS(#INITMOV,0)\n");
        for part in 0..ranges.len() {
            main += &format!("{}( )\n", of_part(name, part));
        }
        files.push((format!("{name}.src"), (main + "END\n").into_bytes()));
    }
    let several = ranges.len() > 1;
    let mut tool = None;
    for (part, range) in ranges.into_iter().enumerate() {
        let own = match several {
            true => of_part(name, part),
            false => name.to_owned(),
        };
        let mut writer = Writer {
            template,
            text: format!("&ACCESS RVP\nDEF {own}( )\n"),
            speed: String::new(),
            zone: String::new(),
            tool,
        };
        if !several {
            writer.text += &format!("; {made_by}\nBAS(#INITMOV,0)\n");
        }
        writer.begin(part == 0);
        for step in &steps[range] {
            writer.step(step);
        }
        tool = writer.tool;
        writer.text += "END\n";
        files.push((format!("{own}.src"), writer.text.into_bytes()));
    }
    files
}

struct Writer<'t> {
    template: &'t Template,
    text: String,
    /// Speed as written last.
    speed: String,
    zone: String,
    tool: Option<u32>,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        self.text += line;
        self.text.push('\n');
    }

    fn begin(&mut self, is_first: bool) {
        let base = self.frame(&self.template.base, "BASE_DATA");
        self.line(&format!("$BASE={base}"));
        self.tool_line();
        self.line("$ORI_TYPE=#VAR");
        self.line("$CIRC_TYPE=#BASE");
        self.line("$ADVANCE=3");
        let percent = short(self.template.joint_speed_percent, 3);
        self.line(&format!("BAS(#VEL_PTP,{percent})"));
        if let Some(acceleration) = self.template.acceleration_m_per_s2 {
            self.line(&format!("$ACC.CP={}", short(acceleration, 6)));
        }
        if self.template.zones.rapids_percent > 0.0 {
            let percent = short(self.template.zones.rapids_percent, 3);
            self.line(&format!("$APO.CPTP={percent}"));
        }
        if let (true, Some(joints)) = (is_first, &self.template.start_joints_deg) {
            let joints: Vec<String> = (joints.iter().enumerate())
                .map(|(axis, value)| format!("A{} {}", axis + 1, short(*value, 6)))
                .collect();
            self.line(&format!("PTP {{{}}}", joints.join(",")));
        }
    }

    fn tool_line(&mut self) {
        let stated = self
            .tool
            .and_then(|number| self.template.tools.get(&number));
        let stated = stated.unwrap_or(&self.template.tool);
        let tool = self.frame(&stated.frame, "TOOL_DATA");
        self.line(&format!("$TOOL={tool}"));
        if let Some(load) = self.load(stated) {
            self.line(&format!("$LOAD={load}"));
        }
    }

    /// Payload of the flange; `None` if no tool has a mass.
    fn load(&self, tool: &StatedTool) -> Option<String> {
        let mut all = self.template.tools.values().chain([&self.template.tool]);
        if all.all(|other| other.mass_kg.is_none()) {
            return None;
        }
        let Some(mass) = tool.mass_kg else {
            // A mass of -1 stands for the largest load that the robot may carry.
            let rated = "{M -1,CM {X 0,Y 0,Z 0,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}".to_owned();
            let of_controller = tool.frame.pose.is_none().then_some(1);
            let number = tool.frame.number.or(of_controller);
            return Some(number.map_or(rated, |number| format!("LOAD_DATA[{number}]")));
        };
        let turn = tool.axes_of_moment.unwrap_or_default();
        let centre = self.pose(&tool.centre_of_mass_mm.unwrap_or_default(), &turn, "");
        let j = tool.inertia_kg_m2.unwrap_or_default();
        let [x, y, z] = [j.x, j.y, j.z].map(|value| short(value, 9));
        let mass = short(mass, 6);
        Some(format!("{{M {mass},CM {centre},J {{X {x},Y {y},Z {z}}}}}"))
    }

    fn frame(&self, frame: &StatedFrame, array: &str) -> String {
        match &frame.pose {
            Some(pose) => self.pose(&pose.translation.vector, &pose.rotation, ""),
            None => format!("{array}[{}]", frame.number.unwrap_or(1)),
        }
    }

    fn pose(&self, place: &Vector3<f64>, turn: &UnitQuaternion<f64>, behind: &str) -> String {
        let [x, y, z] = coordinates(place, self.template.position_decimals);
        let abc = angles(turn, OrientationText::Abc, self.template.angle_decimals);
        format!(
            "{{X {x},Y {y},Z {z},A {},B {},C {}{behind}}}",
            abc[0], abc[1], abc[2]
        )
    }

    fn step(&mut self, step: &Step) {
        match step {
            Step::Note(text) => self.line(&format!("; {text}")),
            Step::Action(EventAction::Wait { seconds }) => {
                self.line(&format!("WAIT SEC {}", short(*seconds, 6)));
            }
            Step::Action(EventAction::Stop | EventAction::OptionalStop) => self.line("HALT"),
            Step::Action(_) => {}
            Step::Statement(text) => self.line(text),
            Step::Tool(number) => {
                self.tool = Some(*number);
                self.tool_line();
            }
            Step::Motion(motion) => self.motion(motion),
        }
    }

    fn motion(&mut self, motion: &MadeMotion) {
        let orientation = motion.orientation.unwrap_or_default();
        let behind = |stated: &str| format!(",{stated}");
        let configuration = match (&self.template.configuration, motion.first) {
            (Some(configuration), true) => behind(configuration),
            _ => motion.end_configuration().map_or_else(String::new, behind),
        };
        let end = self.pose(&motion.end, &orientation, &configuration);
        let zones = &self.template.zones;
        if motion.way == Way::Joint {
            let zone = match motion.exact || zones.rapids_percent == 0.0 {
                true => "",
                false => " C_PTP",
            };
            return self.line(&format!("PTP {end}{zone}"));
        }
        // The template states decimals of mm/s.
        let decimals = self.template.speed_decimals.map_or(12, |own| own + 3);
        let speed = format!(
            "$VEL.CP={}",
            short(motion.speed_mm_per_s / 1000.0, decimals)
        );
        if speed != self.speed {
            self.line(&speed);
            self.speed = speed;
        }
        let distance = match motion.rapid {
            true => zones.rapids_mm,
            false => zones.feeds_mm,
        };
        let passes = !motion.exact && distance > 0.0;
        if passes {
            let zone = format!("$APO.CDIS={}", short(distance, 6));
            if zone != self.zone {
                self.line(&zone);
                self.zone = zone;
            }
        }
        let zone = match passes {
            true => " C_DIS",
            false => "",
        };
        match motion.way {
            Way::Circle {
                via,
                via_orientation,
            } => {
                let stated = motion.via_configuration();
                let stated = stated.map_or_else(String::new, behind);
                let via = self.pose(&via, &via_orientation.unwrap_or(orientation), &stated);
                self.line(&format!("CIRC {via},{end}{zone}"));
            }
            _ => self.line(&format!("LIN {end}{zone}")),
        }
    }
}
