//! Staubli VAL3: programs with the data of their application.

mod broken;
mod corrections;
mod runs;

use kinetostat_formats::*;

/// A frame on a frame, a tool on a tool, a slow and a quick motion, and a point in all its numbers.
const DATA: &str = r#"    <Data name="fCell" access="private" xsi:type="array" type="frame" size="1">
      <Value key="0" x="100" y="0" z="0" rx="0" ry="0" rz="90" fatherId="world[0]" />
    </Data>
    <Data name="fPart" access="private" xsi:type="array" type="frame" size="2">
      <Value key="1" x="10" y="20" z="30" fatherId="fCell[0]" />
    </Data>
    <Data name="tMill" access="private" xsi:type="array" type="tool" size="1">
      <Value key="0" z="150" fatherId="flange[0]" ioLink="valve1" />
    </Data>
    <Data name="mCut" access="private" xsi:type="array" type="mdesc" size="1">
      <Value key="0" accel="50" vel="50" decel="50" tmax="20" rmax="99999" blend="off" leave="50" reach="50" />
    </Data>
    <Data name="mFast" access="private" xsi:type="array" type="mdesc" size="1" />
    <Data name="jHome" access="private" xsi:type="array" type="jointRx" size="1">
      <Value key="0" j3="90" j5="-45.5" />
    </Data>
    <Data name="pA" access="private" xsi:type="array" type="pointRx" size="1">
      <Value key="0" x="600.500" y="10.000" z="50" rx="180" ry="0" rz="-90.00" shoulder="lefty" elbow="epositive" wrist="wpositive" fatherId="fPart[1]" />
    </Data>
    <Data name="pRow" access="private" xsi:type="array" type="pointRx" size="3">
      <Value key="0" x="610" y="0" z="50" rx="180" ry="0" rz="0" fatherId="fPart[1]" />
      <Value key="1" x="620" y="0" z="50" rx="180" ry="0" rz="0" fatherId="fPart[1]" />
      <Value key="2" x="630" fatherId="fPart[1]" />
    </Data>
    <Data name="nCount" access="private" xsi:type="array" type="num" size="1" />
    <Data name="bGo" access="private" xsi:type="array" type="dio" size="1" />
"#;

/// The data of an application.
fn data_of(data: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\n  <Datas>\n{data}  </Datas>\n</Database>\n"
    )
}

/// A program with its declarations.
fn program_of(name: &str, declarations: &str, statements: &str) -> String {
    format!(
        "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<Programs xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n  <Program name=\"{name}\" access=\"public\">\n{declarations}    <Code><![CDATA[begin\n{statements}\nend]]></Code>\n  </Program>\n</Programs>\n"
    )
}

/// Statements in `start`, with the data of all tests and further programs.
fn files_with(statements: &str, others: &[(&str, &str, &str)]) -> Vec<SourceFile> {
    let start = program_of("start", "", statements);
    let mut files = vec![
        SourceFile::new("start.pgx", start),
        SourceFile::new("cell.dtx", data_of(DATA)),
    ];
    files.extend(others.iter().map(|(name, declarations, statements)| {
        let text = program_of(name, declarations, statements);
        SourceFile::new(format!("{name}.pgx"), text)
    }));
    files
}

fn read_with(statements: &str) -> Result<RobotProgram, Vec<ProgramError>> {
    read_val3(files_with(statements, &[]), &ReadOptions::default())
}

fn program(statements: &str) -> RobotProgram {
    read_with(statements).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

/// Places of the ends of all motions, mm.
fn places(program: &RobotProgram) -> Vec<[f64; 3]> {
    let ends = program
        .motions
        .iter()
        .filter_map(|motion| motion.target.pose());
    ends.map(|pose| pose.position_mm.into()).collect()
}

/// The files of a program with pieces: the program and the data.
fn written(program: &RobotProgram, pieces: &[Piece]) -> Vec<String> {
    let files = write(program, pieces, &WriteOptions::default()).unwrap();
    let texts = files.into_iter();
    texts
        .map(|(_, bytes)| String::from_utf8(bytes).unwrap())
        .collect()
}

fn assert_close(found: &[f64], expected: &[f64], most: f64) {
    let near = |(one, other): (&f64, &f64)| (one - other).abs() <= most;
    assert!(
        found.iter().zip(expected).all(near),
        "{found:?} {expected:?}"
    );
}
