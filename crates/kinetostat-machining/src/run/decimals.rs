//! Digits behind the point of what a written program states and the original does not.

use std::collections::HashSet;

use kinetostat_program::HEADER_PREFIX;

use crate::result::decimals::WrittenDecimals;

/// A quantity that a number states.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    Length,
    Angle,
}

/// A number with a decimal point, and what it states.
struct Stated<'t> {
    quantity: Quantity,
    text: &'t [u8],
}

/// Fewest and most digits behind the point of lengths and angles in a written program; numbers that stand in the original do not
/// count.
pub(crate) fn written_decimals(original: &[u8], written: &[u8]) -> WrittenDecimals {
    let mut kept = HashSet::new();
    each_number(original, |number| {
        kept.insert(number.text);
    });
    let mut found = WrittenDecimals::default();
    each_number(written, |number| {
        if kept.contains(number.text) {
            return;
        }
        let digits = number.text.iter().rev().take_while(|byte| **byte != b'.');
        let digits = u8::try_from(digits.count()).unwrap_or(u8::MAX);
        found.merge(&match number.quantity {
            Quantity::Length => WrittenDecimals::of_lengths(digits),
            Quantity::Angle => WrittenDecimals::of_angles(digits),
        });
    });
    found
}

/// Every number with a point that stands behind the letter of an axis (`X10.5`, `{X 10.5`, `X = 10.5`), or in the place of one in a
/// list (`[[x,y,z],[q1,...`, `GOTO/x,y,z,i,j,k`). The header that is written before a program counts for nothing.
fn each_number<'t>(text: &'t [u8], mut take: impl FnMut(Stated<'t>)) {
    let header = HEADER_PREFIX.as_bytes();
    let lines = text.split(|byte| *byte == b'\n');
    for line in lines.filter(|line| !line.windows(header.len()).any(|part| part == header)) {
        let mut list = in_list(line);
        let mut at = 0;
        while at < line.len() {
            if !line[at].is_ascii_digit() && line[at] != b'.' {
                at += 1;
                continue;
            }
            let end = line[at..]
                .iter()
                .position(|byte| !byte.is_ascii_digit() && *byte != b'.')
                .map_or(line.len(), |length| at + length);
            let text = &line[at..end];
            let of_list = list.as_mut().filter(|list| list.0 <= at);
            let quantity = of_letter(&line[..at]).or_else(|| {
                let (_, count) = of_list?;
                *count += 1;
                match *count {
                    1..=3 => Some(Quantity::Length),
                    4..=7 => Some(Quantity::Angle),
                    _ => None,
                }
            });
            if let Some(quantity) = quantity.filter(|_| text.contains(&b'.')) {
                take(Stated { quantity, text });
            }
            at = end;
        }
    }
}

/// Start of a list of a place and a direction in a line, with none of its numbers counted yet.
fn in_list(line: &[u8]) -> Option<(usize, usize)> {
    let behind = |word: &[u8]| {
        let found = line.windows(word.len()).position(|part| part == word);
        found.map(|at| (at + word.len(), 0))
    };
    behind(b"[[").or_else(|| behind(b"GOTO"))
}

/// Quantity of a number behind the letter of an axis.
fn of_letter(before: &[u8]) -> Option<Quantity> {
    let is_between = |byte: &u8| matches!(byte, b' ' | b'\t' | b'=' | b'+' | b'-');
    let end = before.len() - before.iter().rev().take_while(|b| is_between(b)).count();
    let (letter, rest) = before[..end].split_last()?;
    let goes_on = |byte: &u8| byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$');
    if rest.last().is_some_and(goes_on) {
        return None;
    }
    match letter {
        b'X' | b'Y' | b'Z' => Some(Quantity::Length),
        b'A' | b'B' | b'C' | b'W' => Some(Quantity::Angle),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::written_decimals;

    #[test]
    fn lengths_and_angles_have_their_own_digits() {
        let of = |original: &str, written: &str| {
            let found = written_decimals(original.as_bytes(), written.as_bytes());
            (found.lengths, found.angles)
        };
        for (original, written, lengths, angles) in [
            (
                "N10G1X10.5Y2 F800",
                "N10G1X10.5Y2.0123 F795.25",
                Some([4, 4]),
                None,
            ),
            (
                "LIN {X 1.0,Y 2.0,Z 3.0,A 1.0,B 2.0,C 3.0}",
                "; kinetostat: A 90.0\nLIN {X 1.000012,Y 2.0,Z 3.0000125,A 1.00000012,B 2.0,C 3.0}",
                Some([6, 7]),
                Some([8, 8]),
            ),
            (
                "MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9]],v10,z0,t0;",
                "MoveL [[1.0123,2,3],[0.99999999,0,0.0001,0],[0,0,0,0],[9E9]],v10,z0,t0;",
                Some([4, 4]),
                Some([4, 8]),
            ),
            (
                "GOTO/1,2,3,0,0,1",
                "GOTO/1.00012,2,3,0,0,1",
                Some([5, 5]),
                None,
            ),
            (
                "X = 1.000 mm, W = 0.000 deg",
                "X = 1.0012 mm, W = 0.000 deg",
                Some([4, 4]),
                None,
            ),
            (
                "L X+1 Y+2 F800",
                "L X+1.0012 Y+2 F800.5",
                Some([4, 4]),
                None,
            ),
        ] {
            assert_eq!(of(original, written), (lengths, angles), "{written}");
        }
    }
}
