//! The machine of a run with each of its tools.

use kinetostat::batch::AlongPath;

use crate::load::tool::{Tool, tool_on};
use crate::postures::orientation::Orientation;
use crate::run::sites::site::Site;
use crate::task::Task;

/// The machine of a run with each of its tools, ready to solve many postures.
pub(crate) struct Machines<'t, 'm> {
    task: &'t Task<'m>,
    /// The first is the machine without one of the tools.
    machines: Vec<AlongPath>,
}

impl<'t, 'm> Machines<'t, 'm> {
    pub fn new(task: &'t Task<'m>) -> Self {
        let machine = match task.placement.orientation_follows {
            true => AlongPath::by_neighbours,
            false => AlongPath::new,
        };
        let machines = std::iter::once(task.mechanism);
        let machines = machines.chain(task.tools.iter().map(|tool| tool.mechanism));
        Self {
            task,
            machines: machines.map(machine).collect(),
        }
    }

    fn tool(&self, site: &Site) -> Option<&'t Tool<'m>> {
        tool_on(self.task.tools, self.task.path(), site.line)
    }

    /// True if two places are cut with one tool.
    pub fn same(&self, one: &Site, other: &Site) -> bool {
        let number = |site: &Site| self.tool(site).map(|tool| tool.number);
        number(one) == number(other)
    }

    /// The machine that cuts at a place, and what is done with the orientation there.
    pub fn at(&self, site: &Site) -> (&AlongPath, Orientation) {
        let tool = self.tool(site);
        let position = |tool: &Tool<'_>| {
            let own = |other: &Tool<'_>| other.number == tool.number;
            self.task.tools.iter().position(own)
        };
        let index = tool.and_then(position).map_or(0, |index| index + 1);
        let load = tool.map_or(&self.task.load, |tool| &tool.load);
        let orientation = Orientation::of(&self.task.placement, load);
        (&self.machines[index], orientation)
    }
}
