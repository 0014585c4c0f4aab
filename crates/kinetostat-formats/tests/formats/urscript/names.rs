//! Which variable a name is: of the program, of a function, of both.

use super::program;

fn x_of(text: &str) -> f64 {
    let program = program(text);
    program
        .motions
        .last()
        .unwrap()
        .target
        .pose()
        .unwrap()
        .position_mm
        .x
}

#[test]
fn free_names_are_those_of_the_program() {
    let go = "movel(p[a,0,0,0,0,0])\nend\n";
    assert_eq!(
        x_of(&format!("def m():\na=1\ndef f():\na=2\nend\nf()\n{go}")),
        2000.0
    );
    assert_eq!(
        x_of(&format!(
            "def m():\na=1\ndef f():\nlocal a=2\nend\nf()\n{go}"
        )),
        1000.0
    );
    assert_eq!(
        x_of(&format!("def m():\ndef f():\nglobal a=3\nend\nf()\n{go}")),
        3000.0
    );
    // An argument is the function's own.
    assert_eq!(
        x_of(&format!("def m():\na=1\ndef f(a):\na=a+1\nend\nf(5)\n{go}")),
        1000.0
    );
    // Of two functions each has its own.
    assert_eq!(
        x_of("def f():\na=7\nend\ndef m():\na=1\nf()\nmovel(p[a,0,0,0,0,0])\nend\nm()\n"),
        1000.0
    );
}
