//! Files and settings: what they give, and what is refused by name.

use kinetostat_cutting::{CutError, CutErrorKind, Probe, Shape, Stock, StockSettings, Tool};
use proptest::prelude::*;

use crate::stock_support::{block, cells, flat};

fn refused<T: std::fmt::Debug>(result: Result<T, CutError>, quantity: &str) -> CutError {
    let error = result.unwrap_err();
    assert_eq!(error.quantity, quantity, "{error}");
    error
}

#[test]
fn cells_and_blocks_that_cannot_be() {
    for cell in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
        refused(StockSettings::with_cell_mm(cell), "cell");
    }
    let one = cells(1.0);
    refused(
        Stock::block([0.0; 3], [0.0, 5.0, 5.0], &one),
        "stock along x",
    );
    refused(
        Stock::block([0.0; 3], [5.0, f64::NAN, 5.0], &one),
        "stock along y",
    );
    refused(
        Stock::block([0.0; 3], [5.0, 5.0, 0.0], &one),
        "height of the stock",
    );
    refused(
        Stock::block([0.0; 3], [1e9, 5.0, 1.0], &one),
        "stock along x",
    );
    refused(
        Stock::block([9e9, 0.0, 0.0], [9e9 + 5.0, 5.0, 1.0], &one),
        "place of the stock",
    );
    refused(Stock::cylinder([0.0; 3], -4.0, 5.0, &one), "stock along x");
    refused(
        Stock::cylinder([0.0; 3], 4.0, f64::NAN, &one),
        "height of the stock",
    );
}

#[test]
fn corners_may_come_in_any_order() {
    assert_eq!(
        block([0.0; 3], [10.0, 8.0, 3.0], 0.5),
        block([10.0, 0.0, 3.0], [0.0, 8.0, 0.0], 0.5)
    );
}

#[test]
fn memory_is_told_and_bounded() {
    // A part of 500 mm by 500 mm with a tool of 6 mm.
    let settings = StockSettings::for_tool(&flat(6.0));
    let stock = Stock::block([0.0; 3], [500.0, 500.0, 50.0], &settings).unwrap();
    assert!(stock.memory_bytes() < 60_000_000 && stock.cells() > 2_700_000);
    assert_eq!(stock.coarsened_from_mm(), None);
    let fine = cells(0.01);
    let error = refused(
        Stock::block([0.0; 3], [500.0, 500.0, 50.0], &fine),
        "memory of the stock",
    );
    assert_eq!(error.kind, CutErrorKind::Stock);
    let stock = Stock::block([0.0; 3], [500.0, 500.0, 50.0], &fine.coarser_if_needed()).unwrap();
    assert!(stock.memory_bytes() <= 500_000_000 && stock.memory_bytes() > 450_000_000);
    assert_eq!(stock.coarsened_from_mm(), Some(0.01));
    let none = cells(1.0).with_memory_bytes(10).coarser_if_needed();
    refused(
        Stock::block([0.0; 3], [5.0; 3], &none),
        "memory of the stock",
    );
}

#[test]
fn moves_that_cannot_be() {
    let tool = flat(6.0);
    let mut stock = block([0.0; 3], [10.0; 3], 0.5);
    let mut probe = Probe::new(&tool);
    let nowhere = [f64::NAN, 0.0, 0.0];
    refused(
        probe.cut(&mut stock, [0.0; 3], nowhere),
        "place of the tool",
    );
    refused(
        probe.stations(&mut stock, nowhere, [0.0; 3]),
        "place of the tool",
    );
    refused(
        probe.engagement(&stock, [0.0; 3], [0.0; 3]),
        "direction of the tool",
    );
    refused(
        probe.engagement(&stock, [0.0; 3], nowhere),
        "place of the tool",
    );
    // No way at all: one station, in air.
    let stations = probe.stations(&mut stock, [5.0; 3], [5.0; 3]).unwrap();
    assert!(stations.len() == 1 && stations[0].engagement.is_air());
}

#[test]
fn maps_of_heights() {
    let map = b"1, 1, 1\n1, 3, 1\n1, 1, 1\n";
    let stock = Stock::height_map(map, "map.csv", [0.0; 3], 10.0, &cells(0.2)).unwrap();
    // 400 mm^2 of 1, and a tent: bilinear, a quarter of 2 in each of four squares.
    assert!(
        (stock.volume_mm3() - (400.0 + 400.0 * 0.5)).abs() < 3.0,
        "{}",
        stock.volume_mm3()
    );
    let read = |bytes: &[u8]| Stock::height_map(bytes, "map.csv", [0.0; 3], 10.0, &cells(0.2));
    let error = refused(read(b"1,2\n3,x\n"), "height");
    assert_eq!(
        (error.line, error.file.as_deref()),
        (Some(2), Some("map.csv"))
    );
    assert_eq!(refused(read(b"1,2\n3\n"), "row of the map").line, Some(2));
    refused(read(b"1,NaN\n3,4\n"), "height");
    refused(read(b"1,2\n"), "map of heights");
    refused(read(b""), "map of heights");
    refused(read(b"0,0\n0,0\n"), "height of the stock");
    refused(
        Stock::height_map(map, "map.csv", [0.0; 3], f64::NAN, &cells(0.2)),
        "spacing of the map",
    );
}

/// The twelve triangles of a block.
fn box_triangles([dx, dy, dz]: [f32; 3]) -> Vec<[[f32; 3]; 3]> {
    let corner = |k: usize| {
        [
            if k & 1 > 0 { dx } else { 0.0 },
            if k & 2 > 0 { dy } else { 0.0 },
            if k & 4 > 0 { dz } else { 0.0 },
        ]
    };
    let faces = [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5],
    ];
    let triangles = |[a, b, c, d]: [usize; 4]| {
        [
            [corner(a), corner(b), corner(c)],
            [corner(a), corner(c), corner(d)],
        ]
    };
    faces.into_iter().flat_map(triangles).collect()
}

fn binary(triangles: &[[[f32; 3]; 3]], header: &[u8]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0_u8; 12]);
        for x in triangle.iter().flatten() {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([0_u8; 2]);
    }
    bytes
}

fn text(triangles: &[[[f32; 3]; 3]]) -> String {
    let mut out = String::from("solid part\n");
    for triangle in triangles {
        out += "facet normal 0 0 1\nouter loop\n";
        for [x, y, z] in triangle {
            out += &format!("vertex {x} {y} {z}\n");
        }
        out += "endloop\nendfacet\n";
    }
    out + "endsolid part\n"
}

#[test]
fn meshes() {
    let triangles = box_triangles([20.0, 10.0, 4.0]);
    let plain = Stock::stl(&binary(&triangles, b"made here"), "part.stl", &cells(0.2)).unwrap();
    assert!(
        (plain.volume_mm3() / 800.0 - 1.0).abs() < 0.01,
        "{}",
        plain.volume_mm3()
    );
    let like_text = Stock::stl(&binary(&triangles, b"solid "), "part.stl", &cells(0.2)).unwrap();
    let of_text = Stock::stl(text(&triangles).as_bytes(), "part.stl", &cells(0.2)).unwrap();
    assert_eq!(plain, like_text);
    assert_eq!(plain, of_text);
    let read = |bytes: &[u8]| Stock::stl(bytes, "part.stl", &cells(0.2));
    let error = refused(read(b"rubbish"), "STL file");
    assert_eq!(error.file.as_deref(), Some("part.stl"));
    let mut short = binary(&triangles, b"");
    short.pop();
    refused(read(&short), "STL file");
    refused(read(&binary(&[], b"")), "triangles of the mesh");
    let far = [[[0.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0], [0.0, 1.0, 1.0]]];
    refused(read(&binary(&far, b"")), "coordinate of the mesh");
    let plate = [[[0.0, 0.0, 1.0], [5.0, 0.0, 1.0], [0.0, 5.0, 1.0]]];
    refused(read(&binary(&plate, b"")), "height of the stock");
    refused(
        read(b"solid x\nfacet normal 0 0 1\nouter loop\nvertex a b c\n"),
        "STL file",
    );
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let settings = StockSettings::with_cell_mm(1.0).unwrap().with_memory_bytes(1_000_000);
        let _ = Stock::stl(&bytes, "any", &settings);
        let _ = Stock::height_map(&bytes, "any", [0.0; 3], 1.0, &settings);
        let text = [b"solid ".as_slice(), &bytes].concat();
        let _ = Stock::stl(&text, "any", &settings);
    }

    #[test]
    fn no_triangles_make_it_panic(
        numbers in prop::collection::vec(prop_oneof![any::<f32>(), -50.0..50.0_f32], 27),
    ) {
        let triangles: Vec<[[f32; 3]; 3]> = numbers
            .chunks_exact(9)
            .map(|n| [[n[0], n[1], n[2]], [n[3], n[4], n[5]], [n[6], n[7], n[8]]])
            .collect();
        let settings = StockSettings::with_cell_mm(1.0).unwrap().with_memory_bytes(1_000_000);
        let _ = Stock::stl(&binary(&triangles, b""), "any", &settings.coarser_if_needed());
    }

    #[test]
    fn no_move_makes_it_panic(
        ends in prop::array::uniform6(prop_oneof![-20.0..20.0, -1e5..1e5]),
        which in 0..4_usize,
    ) {
        let shapes = [
            Shape::Flat,
            Shape::Ball,
            Shape::Bull { corner_radius_mm: 0.5 },
            Shape::Face { lead_angle: 0.2 },
        ];
        let tool = Tool::new(shapes[which], 4.0, 2).unwrap();
        let mut stock = block([-5.0; 3], [5.0; 3], 0.5);
        let before = stock.volume_mm3();
        let [a, b, c, d, e, f] = ends;
        let stations = Probe::new(&tool).stations(&mut stock, [a, b, c], [d, e, f]).unwrap();
        prop_assert!(stations.last().is_some_and(|s| s.share == 1.0));
        let numbers = stations.iter().flat_map(|s| &s.engagement.contacts);
        for c in numbers {
            prop_assert!(c.from_mm >= 0.0 && c.from_mm < c.to_mm && c.entry >= 0.0);
            prop_assert!(c.entry < c.exit && c.exit <= c.entry + std::f64::consts::TAU + 1e-9);
        }
        prop_assert!(stock.volume_mm3() <= before + 1e-6);
    }
}
