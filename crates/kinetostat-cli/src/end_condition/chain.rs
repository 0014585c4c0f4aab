//! The chain of a machine with one limb, commanded for a place, with everything that acts on it.

use kinetostat::number::larger;
use kinetostat::{Load, MotionKind, Wrench};
use kinetostat_analysis::serial_chain::SerialChain;
use nalgebra::Vector3;

use crate::end_condition::coordinates::{CoordinateName, coordinates_of, values_of};
use crate::end_condition::moves::Moves;
use crate::machine::units::unit_of;
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failure};

/// The chain of a machine that is one, commanded for a place.
pub(crate) fn serial_chain(query: &PlaceQuery) -> Answer<SerialChain> {
    Ok(SerialChain::of(&query.posture()?, query.target)?)
}

/// Where the end of a chain can go.
pub(crate) fn moves_of(chain: &SerialChain) -> Moves {
    Moves {
        subject: "chain",
        place: chain.place,
        directions: chain.movable(),
    }
}

/// What every coordinate of a chain is, for people and for tables.
pub(crate) fn coordinates(chain: &SerialChain) -> Vec<CoordinateName> {
    coordinates_of(&chain.chain, &chain.commands)
}

/// Values of all coordinates in their units; of a drive the joint's whole position, command
/// included.
pub(crate) fn values(chain: &SerialChain, coordinates: &[f64]) -> Vec<f64> {
    values_of(&chain.chain, &chain.commands, coordinates)
}

/// A dead force at a node, written `NODE=FX,FY,FZ`.
pub(crate) fn node_force(chain: &SerialChain, option: &str, text: &str) -> Answer<Load> {
    let refuse = |reason: String| Failure::input(format!("{option} '{text}': {reason}"));
    let Some((name, values)) = text.split_once('=') else {
        return Err(refuse(format!(
            "write a node of the chain and three forces in N, as in {option} {}=0,0,-100",
            chain.chain.nodes().first().map_or("tip", String::as_str)
        )));
    };
    let name = name.trim();
    let known = chain.chain.nodes();
    let Some(node) = known.iter().position(|n| n == name) else {
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        let near = crate::ui::spelling::nearest(name, &names)
            .map_or_else(|| ".".to_owned(), |n| format!("; did you mean '{n}'?"));
        return Err(refuse(format!(
            "the chain has no node '{name}'{near} It has: {}. A model file names one with {{ node = \"NAME\" }}",
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

/// A motion of all coordinates in words: the joints that move most, each by how much while the
/// largest turns by one degree (or slides by one millimetre, where nothing turns).
pub(crate) fn mode_in_words(chain: &SerialChain, mode: &[f64]) -> String {
    let coordinates = chain.chain.coordinates();
    let largest = |kind: MotionKind| {
        coordinates
            .iter()
            .zip(mode)
            .filter(|(c, _)| c.kind == kind)
            .map(|(c, m)| m.abs() * unit_of(c.kind))
            .fold(0.0, larger)
    };
    let (turns, slides) = (
        largest(MotionKind::Revolute),
        largest(MotionKind::Prismatic),
    );
    // Radians against the natural length decide which kind leads.
    let length = 1e3 * chain.chain.scale().length;
    let unit = if turns.to_radians() * length >= slides {
        turns
    } else {
        slides
    };
    if unit <= 0.0 {
        return "nothing moves".into();
    }
    let mut parts: Vec<(f64, String)> = coordinates
        .iter()
        .zip(mode)
        .filter_map(|(c, m)| {
            let by = m * unit_of(c.kind) / unit;
            let (size, word) = match c.kind {
                MotionKind::Revolute => (by.abs().to_radians() * length, "deg"),
                MotionKind::Prismatic => (by.abs(), "mm"),
            };
            let shown = crate::ui::numbers::fixed(by, 3);
            let something = shown.bytes().any(|b| (b'1'..=b'9').contains(&b));
            something.then(|| (size, format!("{} by {shown} {word}", c.name)))
        })
        .collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let most = parts.first().map_or(0.0, |p| p.0);
    parts.retain(|p| p.0 > 0.02 * most);
    let more = parts.len().saturating_sub(6);
    let mut text: Vec<String> = parts.into_iter().take(6).map(|p| p.1).collect();
    if more > 0 {
        text.push(format!("{more} more by less"));
    }
    text.join(", ")
}
