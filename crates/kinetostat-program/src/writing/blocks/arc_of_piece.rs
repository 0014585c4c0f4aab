//! I, J, K or R of a piece that is an arc.

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::path::curve::Curve;
use crate::writing::arc_words::{ArcWord, ToPrint};
use crate::writing::blocks::axis_words::AxisWords;
use crate::writing::blocks::block_text::{BlockText, Place};
use crate::writing::fitting::stretch::ArcForm;
use crate::writing::output_state::{OutputMove, OutputState};

/// Form of the arc in the block: radius or centre.
pub(crate) fn arc_form(text: &BlockText<'_>) -> ArcForm {
    match text.word(b'R') {
        Some(_) => ArcForm::Radius,
        None => ArcForm::Centre,
    }
}

/// Words of a piece that begins at a place and is an arc, after its axis words; none of a straight one.
pub(crate) fn arc_words(
    axes: &AxisWords<'_>,
    state: &mut OutputState,
    step: &OutputMove,
    from: Vector3<f64>,
    place: Place,
) -> Result<Vec<ArcWord>, WriteError> {
    state.arc = None;
    let (Some(fitted), Curve::Arc(arc)) = (&step.arc, &axes.motion.curve) else {
        return Ok(Vec::new());
    };
    let words = &axes.motion.words;
    let to_print = ToPrint {
        fitted,
        normal: arc.axis.imax(),
        from,
        to: state.position,
        reference: match words.absolute_centre {
            true => words.work_offset_mm + state.offset.active_mm,
            false => from,
        },
        mm_per_unit: words.mm_per_unit,
        decimals: axes.decimals,
    };
    let standing = |letter: u8| match place {
        Place::OwnLine => axes.text.number_of(letter),
        Place::FurtherLine => None,
    };
    // On the block's own line a missing word is a centre right beside the start.
    let missing = (place == Place::OwnLine && !words.absolute_centre).then_some(0.0);
    let printed = match arc_form(&axes.text) {
        ArcForm::Radius => to_print.radius(standing(b'R')),
        ArcForm::Centre => to_print.centre(b"IJK".map(|letter| standing(letter).or(missing))),
    };
    let (written, words) = printed.ok_or(WriteError::Verification {
        line: axes.motion.line,
        output_line: 0,
        what: "an arc that was fitted cannot be printed".to_owned(),
    })?;
    state.arc = Some(written);
    Ok(words)
}
