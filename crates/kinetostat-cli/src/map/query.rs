//! The query of `map`: grid and load.

use kinetostat::Wrench;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::Grid;
use nalgebra::Vector3;

use crate::map::arguments::MapArgs;
use crate::options::vector;
use crate::ui::failure::{Answer, Failing};

/// Upper limit of the places: more are a typing error, and their table would fill a disk.
const MOST_PLACES: usize = 100_000_000;

/// Places along an axis unless said otherwise.
const USUAL: usize = 21;

pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

pub(crate) fn grid(args: &MapArgs, home_mm: [f64; 3]) -> Answer<Grid> {
    let mut grid = Grid {
        from_mm: home_mm,
        to_mm: home_mm,
        counts: [1; 3],
    };
    let requested = [&args.x, &args.y, &args.z];
    if requested.iter().all(|a| a.is_none()) {
        return Err(ErrorCode::Missing.failure("a map needs places; give at least one of --x, --y and --z, as in --x -100 100 21 (from, to in mm, how many)",
        ));
    }
    for (k, values) in requested.into_iter().enumerate() {
        let Some(values) = values else { continue };
        let name = AXES[k];
        if values.iter().take(2).any(|x| x.abs() > 1e7) {
            return Err(ErrorCode::Value.failure(format!(
                "--{name} leads more than 10 km away; coordinates are in mm"
            )));
        }
        (grid.from_mm[k], grid.to_mm[k], grid.counts[k]) = match values[..] {
            [at] => (at, at, 1),
            [from, to] if from == to => (from, to, 1),
            [from, to] => (from, to, USUAL),
            [from, to, n] if n.fract() == 0.0 && n >= 1.0 && n <= MOST_PLACES as f64 => {
                if (n == 1.0) != (from == to) {
                    return Err(ErrorCode::Value.failure(format!(
                            "--{name} {from} {to} {n}: two places or more lie between different ends, one place where they are the same"
                        ),
                    ));
                }
                (from, to, n as usize)
            }
            _ => {
                return Err(ErrorCode::Value.failure(format!(
                        "--{name}: write one position, or from, to (mm) and a whole number of places, as in --{name} -100 100 21"
                    ),
                ));
            }
        };
        // Files and drawings of grids want places that rise.
        if grid.from_mm[k] > grid.to_mm[k] {
            std::mem::swap(&mut grid.from_mm[k], &mut grid.to_mm[k]);
        }
    }
    if grid.len() > MOST_PLACES {
        return Err(ErrorCode::Value.failure(format!(
            "the grid has {} places; {MOST_PLACES} are the most",
            grid.len()
        )));
    }
    Ok(grid)
}

/// All loads, none where nothing was said.
pub(crate) fn loads(args: &MapArgs) -> Answer<Vec<Wrench>> {
    let triples = |name: &str, values: &Option<Vec<f64>>| -> Answer<Vec<Vector3<f64>>> {
        let values = values.as_deref().unwrap_or_default();
        values.chunks(3).map(|v| vector(name, v)).collect()
    };
    let forces = triples("--force", &args.force)?;
    let moments = triples("--moment", &args.moment)?;
    let count = forces.len().max(moments.len());
    let of = |list: &[Vector3<f64>], i: usize| match list.len() {
        0 => Some(Vector3::zeros()),
        1 => Some(list[0]),
        _ => list.get(i).copied(),
    };
    let each = (0..count).map(|i| match (of(&forces, i), of(&moments, i)) {
        (Some(force), Some(moment)) => Ok(Wrench::new(force, moment)),
        _ => Err(ErrorCode::Conflict.failure(format!(
            "there are {} forces and {} moments; give one for all, or as many of both",
            forces.len(),
            moments.len()
        ))),
    });
    each.collect()
}
