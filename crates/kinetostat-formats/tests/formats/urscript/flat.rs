//! Programs written flat: the statements of their run, one after the other.

use kinetostat_formats::*;

use super::{moved, program, written};

fn flat(text: &str) -> String {
    let files = vec![SourceFile::new("part.script", text)];
    let found = expand(Language::UrScript, files, &ReadOptions::default());
    let found = found
        .unwrap_or_else(|errors| panic!("{errors:#?}"))
        .unwrap();
    String::from_utf8(found.file.bytes().to_vec()).unwrap()
}

#[test]
fn loops_and_functions_become_statements() {
    let text = "def part():\n  def go(x, f):\n    movel(pose_trans(f, p[x,0,0,0,0,0]), v=0.02)\n  end\n  global f = p[0.5,0,0,0,0,0]\n  i = 0\n\
                  while i < 2:\n    go(0.1*i, f)\n    i = i + 1\n  end\n  set_digital_out(0, True)\nend\n";
    let output = flat(text);
    let before = program(text);
    let after = program(&output);
    let places = |program: &RobotProgram| -> Vec<_> {
        program
            .motions
            .iter()
            .map(|of| of.base_pose().unwrap().translation.vector)
            .collect()
    };
    assert_eq!(places(&before), places(&after), "{output}");
    assert!(
        !output.contains("while") && !output.contains("def go"),
        "{output}"
    );
    let line = "movel(pose_trans(p[0.5,0,0,0,0,0], p[0.1,0,0,0,0,0]), v=0.02)\n  i = i + 1\n";
    assert!(output.contains(line), "{output}");
    // Each run has numbers of its own then.
    let pieces = [
        moved(&after, 0, [0.0, 0.1, 0.0]),
        moved(&after, 1, [0.0, 0.2, 0.0]),
    ];
    assert!(written(&after, &pieces).contains("p[0.1,0.000200,0,0,0,0]), v=0.02"));
}

#[test]
fn a_thread_between_the_statements_stays() {
    let text = "def part():\n  x = 1\n  thread t():\n    while True:\n      sync()\n    end\n  end\n  run t()\n  movel(p[x,0,0,0,0,0])\nend\n";
    let output = flat(text);
    assert_eq!(output.matches("thread t():").count(), 1, "{output}");
    assert_eq!(program(&output).motions.len(), 1);
}
