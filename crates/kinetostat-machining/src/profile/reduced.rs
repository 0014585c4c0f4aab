//! The places that a profile needs: the others lie close to the lines between them.

use crate::profile::by_move::between;

/// The vertices that are needed (Ramer, Douglas and Peucker): of the others, what lies between the needed ones differs by less
/// than what counts. `size` of a difference is 1 where it begins to count.
pub(crate) fn reduced<const N: usize>(
    vertices: &[(f64, [f64; N])],
    size: impl Fn(&[f64; N]) -> f64,
) -> Vec<(f64, [f64; N])> {
    let Some(first) = vertices.first() else {
        return Vec::new();
    };
    let mut needed = vec![*first];
    // Spans that are still to be looked at, the first on top.
    let mut open = vec![(0, vertices.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let (a, b) = (&vertices[from], &vertices[to]);
        let mut worst = (1.0, 0);
        for i in from + 1..to {
            let (at, value) = &vertices[i];
            let part = match b.0 > a.0 {
                true => (at - a.0) / (b.0 - a.0),
                false => 0.0,
            };
            let line = between(&a.1, &b.1, part);
            let off = size(&std::array::from_fn(|k| value[k] - line[k]));
            if off > worst.0 {
                worst = (off, i);
            }
        }
        match worst.1 {
            0 if to > from => needed.push(*b),
            0 => {}
            middle => open.extend([(middle, to), (from, middle)]),
        }
    }
    needed
}
