//! The walk over a document as a whole.

use crate::parameters::walk::{Numbers, Visit, step};
use crate::schema::Document;

/// All numbers of a document, always in the same order.
pub(crate) fn walk(document: &mut Document, visit: &mut dyn Visit) {
    let Document {
        schema: _,
        // Damping has no effect in statics.
        damping: _,
        mechanism,
        workspace,
        platform,
        section,
        stiffness,
        chain,
        limb,
        load,
        deviation,
        rotary_axis,
        controller,
    } = document;
    step("mechanism", mechanism, "mechanism", visit);
    step("workspace", workspace, "workspace", visit);
    for platform in platform {
        let name = platform.name.clone();
        within(["platform", &name], platform, visit);
    }
    step("section", section, "section", visit);
    step("stiffness", stiffness, "stiffness", visit);
    step("chain", chain, "chain", visit);
    for limb in limb {
        visit.enter("limb");
        visit.enter(&limb.name);
        step("start", &mut limb.start, "start", visit);
        step("end", &mut limb.end, "end", visit);
        for load in &mut limb.load {
            let name = load.name().to_owned();
            within(["load", &name], load, visit);
        }
        visit.leave();
        visit.leave();
    }
    for load in load {
        let name = load.name().to_owned();
        within(["load", &name], load, visit);
    }
    for deviation in deviation {
        visit.enter("deviation");
        let (limb, at) = (deviation.limb.clone(), deviation.at.clone());
        within([&limb, &at], deviation, visit);
        visit.leave();
    }
    for axis in rotary_axis {
        let word = axis.word.letter().to_string();
        within(["rotary_axis", &word], axis, visit);
    }
    step("controller", controller, "controller", visit);
}

fn within([outer, inner]: [&str; 2], value: &mut dyn Numbers, visit: &mut dyn Visit) {
    visit.enter(outer);
    step(inner, value, "", visit);
    visit.leave();
}
