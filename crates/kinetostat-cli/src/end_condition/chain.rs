//! The chain of a machine with one limb, commanded for a place, with everything that acts on it.

use kinetostat::{Chain, Equilibrium, Load, Wrench};
use kinetostat_analysis::outline::chain_outline;
use kinetostat_analysis::serial_chain::SerialChain;
use kinetostat_diagnostic::ErrorCode;
use nalgebra::Vector3;

use crate::end_condition::coordinates::{CoordinateName, coordinates_of, values_of};
use crate::end_condition::moves::Moves;
use crate::end_condition::subject::{Subject, motion_description};
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failing};

/// The chain of a machine that is one, commanded for a place.
pub(crate) fn serial_chain(query: &PlaceQuery) -> Answer<SerialChain> {
    Ok(SerialChain::of(&query.posture()?, query.target)?)
}

/// Possible motions of the end of a chain.
pub(crate) fn moves_of(chain: &SerialChain) -> Moves {
    Moves {
        subject: "chain",
        place: chain.place,
        directions: chain.movable(),
    }
}

impl Subject for SerialChain {
    type Equilibrium = Equilibrium;

    fn coordinates(&self) -> Vec<CoordinateName> {
        coordinates_of(&self.chain, &self.commands)
    }

    fn values(&self, e: &Equilibrium) -> Vec<f64> {
        values_of(&self.chain, &self.commands, &e.coordinates)
    }

    fn outline(&self, e: &Equilibrium) -> Vec<Vector3<f64>> {
        chain_outline(&self.chain, &self.base, &self.commands, &e.coordinates)
    }

    fn motion_description(&self, motion: &[f64]) -> String {
        let coordinates = self.chain.coordinates().iter();
        let parts: Vec<_> = coordinates.map(|c| (c.name.clone(), c.kind)).collect();
        motion_description(&parts, motion, self.chain.scale().length)
    }
}

/// A dead force at a node of a chain, written `NODE=FX,FY,FZ`; `before`: what stands in the option before the node.
pub(crate) fn node_force(chain: &Chain, option: &str, before: &str, text: &str) -> Answer<Load> {
    let refuse =
        |reason: String| ErrorCode::Value.failure(format!("{option} '{before}{text}': {reason}"));
    let Some((name, values)) = text.split_once('=') else {
        return Err(refuse(format!(
            "write a node of the chain and three forces in N, as in {option} {before}{}=0,0,-100",
            chain.nodes().first().map_or("tip", String::as_str)
        )));
    };
    let name = name.trim();
    let known = chain.nodes();
    let Some(node) = known.iter().position(|n| n == name) else {
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        let near = crate::ui::spelling::nearest(name, &names)
            .map_or_else(|| ".".to_owned(), |n| format!("; did you mean '{n}'?"));
        let whose = match before.trim_end_matches(':') {
            "" => "the chain".to_owned(),
            limb => format!("the limb '{limb}'"),
        };
        return Err(refuse(format!(
            "{whose} has no node '{name}'{near} It has: {}. A model file names one with {{ node = \"NAME\" }}",
            known.join(", ")
        )));
    };
    let numbers: Vec<f64> = values
        .split(',')
        .map(|v| v.trim().parse::<f64>().ok().filter(|x| x.is_finite()))
        .collect::<Option<_>>()
        .filter(|list: &Vec<f64>| list.len() == 3)
        .ok_or_else(|| {
            refuse("three numbers with decimal points, separated by commas, are needed (N)".into())
        })?;
    let force = Vector3::new(numbers[0], numbers[1], numbers[2]);
    Ok(Load::dead(node, Wrench::new(force, Vector3::zeros())))
}
