//! The direct solver of sparse matrices.

use kinetostat_links::internal::{Factor, NoFactor};

/// Laplacian of a 7 x 5 grid, one corner tied to the ground.
#[test]
fn solves_a_grid_and_names_what_is_not_held() {
    let (w, h) = (7_u32, 5_u32);
    let mut entries = Vec::new();
    let mut diagonal = vec![0.0; (w * h) as usize];
    for y in 0..h {
        for x in 0..w {
            let i = y * w + x;
            for j in [(x + 1 < w).then_some(i + 1), (y + 1 < h).then_some(i + w)]
                .into_iter()
                .flatten()
            {
                entries.push((j, i, -1.0));
                diagonal[i as usize] += 1.0;
                diagonal[j as usize] += 1.0;
            }
        }
    }
    let free = |d: &[f64]| -> Vec<(u32, u32, f64)> {
        entries
            .iter()
            .copied()
            .chain((0..w * h).map(|i| (i, i, d[i as usize])))
            .collect()
    };
    assert!(matches!(
        Factor::new(35, &free(&diagonal)),
        Err(NoFactor::NotHeld(..))
    ));
    diagonal[3] += 0.5;
    let all = free(&diagonal);
    let factor = Factor::new(35, &all)
        .map_err(|e| format!("{e:?}"))
        .expect("held");
    let wanted: Vec<f64> = (0..35).map(|i| f64::from(i * i % 11) - 4.0).collect();
    let mut b = vec![0.0; 35];
    for (i, j, v) in all {
        b[i as usize] += v * wanted[j as usize];
        if i != j {
            b[j as usize] += v * wanted[i as usize];
        }
    }
    let x = factor.solve(&b);
    assert!(x.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-11));
}
