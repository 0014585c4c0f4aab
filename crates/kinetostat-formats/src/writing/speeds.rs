//! The speeds of pieces.

use crate::model::motion::Motion;
use crate::model::site::SpeedSite;
use crate::writing::piece::Piece;
use crate::writing::refusals::Reason;

/// When the speed of a piece is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stated {
    IfChanged,
    Always,
}

/// The speed of a piece where it is written.
pub(super) fn speed_of<'m>(
    motion: &'m Motion,
    piece: &Piece,
    stated: Stated,
) -> Result<Option<(&'m SpeedSite, Vec<u8>)>, Reason> {
    if piece.speed_factor == 1.0 && stated == Stated::IfChanged {
        return Ok(None);
    }
    let (Some(site), Some(speed)) = (&motion.site.speed, motion.speed.mm_per_s) else {
        return Err((
            "its speed cannot be changed: it is not known from the text",
            "state the speed as a number, or keep it",
        ));
    };
    // A tenth of a um/s, whatever the unit.
    let decimals = match site.unit_mm_per_s > 1.0 {
        true => 7,
        false => 4,
    };
    let number = speed * piece.speed_factor / site.unit_mm_per_s;
    let number = format!("{number:.decimals$}");
    let number = number.trim_end_matches('0').trim_end_matches('.');
    let text = [&site.before, number, &site.after].concat();
    Ok(Some((site, text.into_bytes())))
}
