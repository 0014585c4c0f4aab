//! What acts on the tool and on nodes all the time.

use kinetostat::Wrench;
use kinetostat_analysis::serial_chain::SerialChain;
use nalgebra::Vector3;

use crate::end_condition::arguments::EndArgs;
use crate::end_condition::chain::node_force;
use crate::options::vector;
use crate::ui::failure::{Answer, Failure};

/// That forces on nodes are for chains.
pub(crate) fn refuse_nodes(args: &EndArgs) -> Answer<()> {
    match args.load.is_empty() {
        true => Ok(()),
        false => Err(no_nodes("--load")),
    }
}

/// The wrench of two options.
pub(crate) fn wrench(
    force: (&str, Option<&[f64]>),
    moment: (&str, Option<&[f64]>),
) -> Answer<Wrench> {
    let part = |(name, values): (&str, Option<&[f64]>)| {
        values.map_or_else(|| Ok(Vector3::zeros()), |v| vector(name, v))
    };
    Ok(Wrench::new(part(force)?, part(moment)?))
}

/// The wrench that acts all the time.
pub(crate) fn constant(args: &EndArgs) -> Answer<Wrench> {
    wrench(
        ("--constant-force", args.constant_force.as_deref()),
        ("--constant-moment", args.constant_moment.as_deref()),
    )
}

/// A force on a node was requested of a machine.
pub(crate) fn no_nodes(option: &str) -> Failure {
    Failure::input(format!(
        "{option} puts a force on a node of a chain, and this model has several limbs; write such a load into the model file, or a force on the tool"
    ))
}

/// Adds the forces on nodes that act all the time.
pub(crate) fn with_loads(mut chain: SerialChain, args: &EndArgs) -> Answer<SerialChain> {
    for text in &args.load {
        let load = node_force(&chain, "--load", text)?;
        chain.loads.push(load);
    }
    Ok(chain)
}

/// What acts all the time, in words; nothing if nothing does.
pub(crate) fn constant_in_words(args: &EndArgs) -> String {
    let mut parts = Vec::new();
    if let Some(f) = &args.constant_force {
        parts.push(format!(
            "the force ({}, {}, {}) N on the tool",
            f[0], f[1], f[2]
        ));
    }
    if let Some(m) = &args.constant_moment {
        parts.push(format!(
            "the moment ({}, {}, {}) N m on the tool",
            m[0], m[1], m[2]
        ));
    }
    for text in &args.load {
        if let Some((node, force)) = text.split_once('=') {
            parts.push(format!("the force ({force}) N on '{}'", node.trim()));
        }
    }
    if parts.is_empty() {
        String::new()
    } else {
        format!(" All the time: {}.", parts.join(", "))
    }
}
