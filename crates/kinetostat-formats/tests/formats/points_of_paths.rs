//! Tables row by row as Parquet and lines as VTK, read back by what does not come from here: the `parquet` crate's reader, and the
//! description of VTK's legacy form.

use kinetostat_formats::fields::{PointQuantity, Polylines};

/// Reads a legacy file of polygonal data, big-endian, word by word.
struct Legacy<'a>(&'a [u8]);

impl<'a> Legacy<'a> {
    fn line(&mut self) -> &'a str {
        let end = self.0.iter().position(|b| *b == b'\n').unwrap();
        let (line, rest) = self.0.split_at(end);
        self.0 = &rest[1..];
        std::str::from_utf8(line).unwrap()
    }

    fn doubles(&mut self, count: usize) -> Vec<f64> {
        let (bytes, rest) = self.0.split_at(8 * count);
        assert_eq!(rest[0], b'\n');
        self.0 = &rest[1..];
        let (each, _) = bytes.as_chunks::<8>();
        each.iter().map(|b| f64::from_be_bytes(*b)).collect()
    }

    fn indices(&mut self, count: usize) -> Vec<i32> {
        let (bytes, rest) = self.0.split_at(4 * count);
        assert_eq!(rest[0], b'\n');
        self.0 = &rest[1..];
        let (each, _) = bytes.as_chunks::<4>();
        each.iter().map(|b| i32::from_be_bytes(*b)).collect()
    }
}

#[test]
fn lines_and_points_of_no_line_are_read_back() {
    let points = vec![
        [1.0, 2.0, 3.0],
        [-4.5, 0.25, 1e-7],
        [7.0, -8.0, 9.0],
        [0.1, 0.2, 0.3],
        [5.0, 5.0, 5.0],
    ];
    let of = |name: &str, width: usize| PointQuantity {
        name: name.to_owned(),
        width,
        values: (0..5 * width)
            .map(|i| if i == 3 { f64::NAN } else { i as f64 - 0.5 })
            .collect(),
    };
    let quantities = vec![of("share", 1), of("force_n", 3), of("compliance", 9)];
    let file = Polylines {
        title: "part, mm\nof \u{e9}t\u{e9}".into(),
        points: points.clone(),
        lines: vec![2, 2],
        quantities: quantities.clone(),
    }
    .vtk();
    let mut read = Legacy(&file);
    assert_eq!(read.line(), "# vtk DataFile Version 3.0");
    // A title of two lines would end the header.
    assert!(read.line().starts_with("part, mm"));
    assert_eq!(read.line(), "BINARY");
    assert_eq!(read.line(), "DATASET POLYDATA");
    assert_eq!(read.line(), "POINTS 5 double");
    assert_eq!(read.doubles(15), points.as_flattened());
    assert_eq!(read.line(), "VERTICES 1 2");
    assert_eq!(read.indices(2), [1, 4]);
    assert_eq!(read.line(), "LINES 2 6");
    assert_eq!(read.indices(6), [2, 0, 1, 2, 2, 3]);
    assert_eq!(read.line(), "POINT_DATA 5");
    for quantity in &quantities {
        match quantity.width {
            1 => {
                assert_eq!(read.line(), "SCALARS share double 1");
                assert_eq!(read.line(), "LOOKUP_TABLE default");
            }
            3 => assert_eq!(read.line(), "VECTORS force_n double"),
            _ => assert_eq!(read.line(), "TENSORS compliance double"),
        }
        let found = read.doubles(quantity.values.len());
        let same = |(a, b): (&f64, &f64)| a == b || (a.is_nan() && b.is_nan());
        assert!(found.iter().zip(&quantity.values).all(same), "{found:?}");
    }
    assert!(read.0.is_empty());
}

#[cfg(feature = "parquet")]
mod rows {
    use kinetostat_formats::fields::{Cell, RowColumn, RowsWriter};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    fn column(name: &str, unit: &str, is_text: bool) -> RowColumn {
        RowColumn {
            name: name.into(),
            unit: unit.into(),
            description: format!("what {name} is"),
            is_text,
        }
    }

    /// More rows than a group has, so that several are written, and one that is not full.
    #[test]
    fn every_row_is_read_back_with_units() {
        const COUNT: usize = (1 << 16) + 10;
        let columns = [column("x_mm", "mm", false), column("kind", "", true)];
        let mut file = Vec::new();
        let facts = [("model".to_owned(), "arm".to_owned())];
        let mut writer = RowsWriter::new(&mut file, &columns, &facts).unwrap();
        for i in 0..COUNT {
            let text = if i % 3 == 0 { "rapid" } else { "cut" };
            let number = if i == 5 { f64::NAN } else { 0.1 * i as f64 };
            writer
                .push([Cell::Number(number), Cell::Text(text)])
                .unwrap();
        }
        // What is missing, or of the other kind, is none.
        writer.push([Cell::Text("no number")]).unwrap();
        writer.finish().unwrap();
        let read = SerializedFileReader::new(bytes::Bytes::from(file)).unwrap();
        assert_eq!(read.metadata().num_row_groups(), 2);
        let known = read
            .metadata()
            .file_metadata()
            .key_value_metadata()
            .unwrap();
        let fact = |name: &str| known.iter().find(|k| k.key == name).unwrap().value.clone();
        assert_eq!(fact("unit.x_mm").as_deref(), Some("mm"));
        assert_eq!(fact("description.kind").as_deref(), Some("what kind is"));
        assert_eq!(fact("model").as_deref(), Some("arm"));
        let mut count = 0;
        for (i, row) in read.get_row_iter(None).unwrap().enumerate() {
            let row = row.unwrap();
            let (number, text) = (row.get_double(0).unwrap(), row.get_string(1).unwrap());
            match i {
                5 => assert!(number.is_nan()),
                COUNT => assert!(number.is_nan() && text.is_empty()),
                _ => assert_eq!(number.to_bits(), (0.1 * i as f64).to_bits()),
            }
            assert!(i == COUNT || (text == "rapid") == (i % 3 == 0));
            count += 1;
        }
        assert_eq!(count, COUNT + 1);
    }

    #[test]
    fn a_sink_that_is_full_is_said() {
        struct Full(usize);
        impl std::io::Write for Full {
            fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
                self.0 = self
                    .0
                    .checked_sub(bytes.len())
                    .ok_or(std::io::ErrorKind::StorageFull)?;
                Ok(bytes.len())
            }
            fn flush(&mut self) -> std::io::Result<()> {
                Ok(())
            }
        }
        let mut writer = RowsWriter::new(Full(200), &[column("x_mm", "mm", false)], &[]).unwrap();
        for i in 0..1000 {
            writer.push([Cell::Number(f64::from(i).sin())]).unwrap();
        }
        let said = writer.finish().unwrap_err().to_string();
        assert!(said.contains("space") || said.contains("full"), "{said}");
    }
}
