//! Words and codes of a block that nobody can tell the meaning of beside its others.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Motion, MoveKind};
use crate::reading::block::Block;
use crate::reading::extra::ExtraAxes;
use crate::reading::moment::{Placed, moment_of};
use crate::reading::options::{OtherAxes, ReadOptions};
use crate::reading::repeated::Repeated;
use crate::text::Word;

/// Letters of the axes that the program is read for.
pub(crate) const COORDINATES: [u8; 3] = *b"XYZ";

/// Axes that change where the tool stands in the part, by way of a table, a head or second slides.
pub(crate) const OTHER_AXES: &[u8; 6] = b"ABCUVW";

/// Words that mean a corner rounding or a call on some controllers.
pub(crate) fn refuse_parameters_of_calls(
    block: &Block<'_>,
    motion: Option<Motion>,
    directions: bool,
) -> Result<(), ProgramError> {
    if block
        .words
        .iter()
        .any(|word| word.letter == b'M' && word.value >= 100.0)
        && block.codes.motion.is_none()
    {
        return Err(block.refuse(
            ProgramErrorKind::Ambiguous,
            None,
            "an axis word beside this M code is its parameter to printers and a motion to mills",
            "write the motion as a block of its own, with G0 or G1",
        ));
    }
    if matches!(motion, Some(Motion::Rapid | Motion::Feed)) {
        // Under G43.5 they say how the tool stands.
        let refused: &[u8] = match directions {
            true => b"RP",
            false => b"IJKRP",
        };
        for letter in refused.iter().copied() {
            // P selects the orientation law under tool centre point control.
            if letter == b'P' && block.codes.tool_centre_point {
                continue;
            }
            if let Some(word) = block.word(letter).filter(|_| block.value(letter).is_some()) {
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous,
                    Some(word),
                    &format!(
                        "{} appears in a straight move: some controllers stop, some round a corner",
                        char::from(letter)
                    ),
                    "remove the word, or write the arc with G2 or G3",
                ));
            }
        }
    }
    Ok(())
}

/// A block with motion may be divided: each of its codes must have a piece to stand in.
pub(crate) fn check_codes_beside_motion(
    block: &Block<'_>,
    kind: MoveKind,
    options: &ReadOptions,
    repeated: &mut Repeated,
) -> Result<(), ProgramError> {
    for word in block.words.iter().filter(|word| word.letter == b'M') {
        let tenths = word.tenths();
        let Some(moment) = moment_of(tenths) else {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous, Some(word),
                &format!(
                    "M{} appears beside a motion, and whether it acts before or after it is not known here",
                    word.value
                ),
                "write it in a block of its own, before or after the motion",
            ));
        };
        if moment.code == 6 && options.tools.is_some() {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous, Some(word),
                "the tool is changed beside a motion: which of the two tools makes the motion depends on the controller",
                "write M6 in a block of its own, before or after the motion",
            ));
        }
        if kind != MoveKind::Feed {
            continue;
        }
        if moment.placed == Placed::Refused {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous, Some(word),
                &format!(
                    "M{} ({}) appears beside a feed motion: some controllers execute it before the motion, some after it",
                    moment.code, moment.meaning
                ),
                "write it in a block of its own, before or after the motion",
            ));
        }
        if moment.is_disputed() {
            repeated.note(block.line_number, &format!(
                "M{} ({}) appears beside a feed motion: some controllers execute it before the motion, some after it; where the block is divided it is written in the last piece. A block of its own says which is meant",
                moment.code, moment.meaning
            ));
        }
    }
    Ok(())
}

/// A place beside a setting of look-ahead or precision: some controllers take it for a parameter, some move there.
pub(crate) fn refuse_beside_look_ahead(
    block: &Block<'_>,
    has_axis_words: bool,
) -> Result<(), ProgramError> {
    let is_axis =
        |word: &Word| COORDINATES.contains(&word.letter) || OTHER_AXES.contains(&word.letter);
    let moves = block.codes.motion.is_some() && block.words.iter().any(is_axis);
    match block.codes.looks_ahead && (has_axis_words || moves) {
        true => Err(block.refuse(
            ProgramErrorKind::Ambiguous,
            None,
            "a place stands beside a setting of look-ahead or precision (G5, G5.1, G103, G187)",
            "write the setting in a block of its own",
        )),
        false => Ok(()),
    }
}

/// Words of axes that turn or shift the part or the head, of which there is no model here.
pub(crate) fn refuse_other_axes(
    block: &Block<'_>,
    options: &ReadOptions,
) -> Result<(), ProgramError> {
    let refused = match options.other_axes {
        OtherAxes::StandStill => return Ok(()),
        OtherAxes::Carried => &OTHER_AXES[3..],
        OtherAxes::Refused => OTHER_AXES,
    };
    for letter in refused.iter().copied() {
        let rotary = options.rotary.iter().flat_map(|rotary| &rotary.axes);
        if rotary
            .map(|axis| axis.letter)
            .any(|known| known == char::from(letter))
        {
            continue;
        }
        if let Some(word) = block.word(letter).filter(|_| block.value(letter).is_some()) {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous, Some(word),
                &format!(
                    "axis {} changes where the tool is in the part and in the machine, and there is no model of it",
                    char::from(letter)
                ),
                "take the word out if the axis stands still, or say that it does: --axes-stand-still, or axes_stand_still = true under [reading]; rotary axes of five-axis machines are described in the model ([[rotary_axis]])",
            ));
        }
    }
    Ok(())
}

/// A time below zero is none, and LinuxCNC counts it as missing.
pub(crate) fn refuse_negative_dwell(block: &Block<'_>) -> Result<(), ProgramError> {
    let times: &[u8] = match block.dwells_before_motion() {
        true => b"P",
        false => b"PXUS",
    };
    let negative = |word: &&Word| times.contains(&word.letter) && word.value < 0.0;
    match block.words.iter().find(negative) {
        Some(word) if block.codes.dwell => Err(block.refuse(
            ProgramErrorKind::Malformed,
            Some(word),
            &format!(
                "a dwell (G4) of {}{} is below zero",
                char::from(word.letter),
                word.value
            ),
            "write a time of zero or more",
        )),
        _ => Ok(()),
    }
}

/// A dwell beside an arc that goes on from the block before: P counts the turns of an arc as well.
pub(crate) fn refuse_dwell_with_arc(
    block: &Block<'_>,
    motion: Option<Motion>,
) -> Result<(), ProgramError> {
    let arc = matches!(motion, Some(Motion::Clockwise | Motion::CounterClockwise));
    match arc && block.dwells_before_motion() {
        true => Err(dwell_and_motion(block)),
        false => Ok(()),
    }
}

fn dwell_and_motion(block: &Block<'_>) -> ProgramError {
    block.refuse(
        ProgramErrorKind::Ambiguous,
        None,
        "a dwell and a motion are in one block: the axis words may belong to either",
        "write them in two blocks",
    )
}

/// `G4 X2` dwells two seconds on some controllers; with P or a motion word beside it nobody can tell.
pub(crate) fn refuse_dwell_with_motion(block: &Block<'_>) -> Result<(), ProgramError> {
    if block.dwells_before_motion() {
        return Ok(());
    }
    let axis = |word: &&Word| {
        COORDINATES.contains(&word.letter) || ExtraAxes::LETTERS.contains(&word.letter)
    };
    let time_elsewhere = block
        .words
        .iter()
        .any(|word| matches!(word.letter, b'P' | b'S'));
    let axes = block.words.iter().filter(axis).count();
    if block.codes.dwell && (block.codes.motion.is_some() || axes > usize::from(!time_elsewhere)) {
        return Err(dwell_and_motion(block));
    }
    Ok(())
}
