//! Forces of a path on another one over the same way, each of whose moves is a part of one of its moves.

use crate::cut::station::CutStation;
use crate::profile::by_move::{Profile, between};

/// The stations of a part of a move, by shares of the part; jumps at its ends belong to what is outside.
pub(crate) fn of_stations(stations: &[CutStation], [from, to]: [f64; 2]) -> Vec<CutStation> {
    let (Some(first), Some(last)) = (stations.first(), stations.last()) else {
        return Vec::new();
    };
    let after = stations.partition_point(|station| station.share <= from);
    let before = after.checked_sub(1).and_then(|index| stations.get(index));
    let begin = at(from, before.unwrap_or(first), stations.get(after), before);
    let next = stations.partition_point(|station| station.share < to);
    let left = next.checked_sub(1).and_then(|index| stations.get(index));
    let right = stations.get(next);
    let end = at(to, left.unwrap_or(first), right, right.or(Some(last)));
    let mut part = vec![CutStation {
        share: 0.0,
        ..begin
    }];
    let inner = stations.get(after..next).unwrap_or_default();
    part.extend(inner.iter().map(|station| CutStation {
        share: (station.share - from) / (to - from),
        ..*station
    }));
    part.push(CutStation { share: 1.0, ..end });
    part
}

/// Wrench at a share between two stations; all other values are those of `like`.
fn at(
    share: f64,
    before: &CutStation,
    after: Option<&CutStation>,
    like: Option<&CutStation>,
) -> CutStation {
    let like = *like.unwrap_or(before);
    match after {
        Some(after) if after.share > before.share => {
            let part = ((share - before.share) / (after.share - before.share)).clamp(0.0, 1.0);
            let wrench = between(&before.wrench.0.into(), &after.wrench.0.into(), part);
            CutStation {
                wrench: kinetostat::Wrench(wrench.into()),
                ..like
            }
        }
        _ => CutStation {
            wrench: before.wrench,
            ..like
        },
    }
}

/// The wrenches of a move as stations.
pub(crate) fn as_stations(profile: &Profile<6>, move_index: usize) -> Vec<CutStation> {
    let vertices = profile.of(move_index).iter();
    vertices
        .map(|(share, wrench)| CutStation {
            wrench: kinetostat::Wrench((*wrench).into()),
            ..CutStation::air(*share)
        })
        .collect()
}
