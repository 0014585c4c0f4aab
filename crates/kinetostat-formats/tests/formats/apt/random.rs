//! Random APT and CLDATA of the dialects that are known, broken by chance.

use kinetostat_formats::*;

use crate::harness::{Chance, Kind};

pub fn kind() -> Kind {
    Kind {
        words: &[
            "GOTO/",
            "GOTO/1,2,3\n",
            "GODLTA/1,2,3\n",
            "RAPID\n",
            "CIRCLE/0,0,0,0,0,1.\n",
            "$",
            "$$",
            "$\n",
            "UNITS/INCH\n",
            "FROM/0,0,0\n",
            "CYCLE/DRILL,1\n",
            "MSYS/0,0,0,1,0,0,0,1,0\n",
            "TLAXIS/0,0,1\n",
            "PPRINT $ GOTO/1,2,3\n",
            "GOHOME/",
            ",0,0,1",
        ],
        ..Kind::of(Language::Apt, ReadOptions::default(), |chance| {
            vec![program(chance)]
        })
    }
}

struct Writer<'c> {
    chance: &'c mut Chance,
    text: String,
    place: [f64; 3],
    dialect: usize,
}

impl Writer<'_> {
    fn goto(&mut self, word: &str, values: &[f64]) {
        let numbers: Vec<String> = values
            .iter()
            .map(|value| match self.dialect {
                0 => format!("{value:.6}").trim_end_matches('0').to_owned(),
                1 => format!("{value:.4}"),
                _ => format!("{value:11.5}"),
            })
            .collect();
        let sign = match self.dialect {
            2 => "  /",
            _ => "/",
        };
        let end = self.chance.of(&["\n", "\n", "\n", " $$ note\n"]);
        self.text += &format!("{word}{sign}{}{end}", numbers.join(","));
    }

    fn move_to_next(&mut self) -> Vec<f64> {
        self.place = [0, 1, 2].map(|_| (self.chance.within(500.0) * 1e4).round() / 1e4);
        self.place.to_vec()
    }

    fn arc(&mut self) {
        let (radius, first) = (5.0 + self.chance.within(4.0), self.chance.within(3.0));
        let by = 3.0 + self.chance.within(2.9);
        let [x, y, z] = self.place;
        let centre = [x - radius * first.cos(), y - radius * first.sin(), z];
        let sense = match self.dialect {
            0 => 1.0,
            _ => -1.0,
        };
        let end = first + by;
        self.place = [
            centre[0] + radius * end.cos(),
            centre[1] + radius * end.sin(),
            z,
        ];
        match self.dialect {
            0 => {
                self.text += &format!(
                    "CIRCLE/{:.6},{:.6},{z:.6},0,0,{sense:.1}\n",
                    centre[0], centre[1]
                )
            }
            _ => {
                self.text += &format!(
                    "CIRCLE/{:.4},{:.4},{z:.4},0.0,0.0,{sense:.4},{radius:.4},0.06,0.5,40.0,1.0\nPAINT/COLOR,31\n",
                    centre[0], centre[1]
                );
            }
        }
        let place = self.place.to_vec();
        self.goto("GOTO", &place);
    }
}

/// A file that is understood.
pub fn program(chance: &mut Chance) -> String {
    let dialect = chance.below(3);
    let head = match dialect {
        0 => {
            "PARTNO/1 GOTO/1,2,3\nUNIT/MM\nLOAD/TOOL,3\nTRNTYP/WORLD,0,0,0\nCSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0\n"
        }
        1 => {
            "TOOL PATH/OP,TOOL,MILL\nTLDATA/MILL,40.0,1.0,50.0,0.0,0.0\nMSYS/3.0,-2.5,3.0,0.0,1.0,0.0,1.0,0.0,0.0\n$$ centerline data\n"
        }
        _ => {
            "$$ CATIA APT VERSION 1.0\nPARTNO part\nUNITS/MM\nCUTTER/ 16.0,  0.0,  8.0,  0.0,  0.0,$\n         0.0, 80.0\n"
        }
    };
    let mut writer = Writer {
        chance,
        text: head.to_owned(),
        place: [0.0; 3],
        dialect,
    };
    let first = writer.move_to_next();
    writer.goto("GOTO", &first);
    for _ in 0..writer.chance.below(14) {
        match writer.chance.below(9) {
            0 => {
                writer.text += ["RAPID/\n", "RAPID\n", "RAPID\n"][dialect];
                let place = writer.move_to_next();
                writer.goto("GOTO", &place);
            }
            1 => {
                writer.text += [
                    "FEDRAT/600.,MMPM\n",
                    "FEDRAT/MMPM,250.0000\n",
                    "FEDRAT/    0.1000,MMPR\n",
                ][dialect]
            }
            2 if dialect < 2 => writer.arc(),
            3 => {
                let by = [0, 1, 2].map(|_| (writer.chance.within(20.0) * 1e3).round() / 1e3);
                for (place, by) in writer.place.iter_mut().zip(by) {
                    *place += by;
                }
                writer.goto("GODLTA", &by);
            }
            4 => {
                let turn = writer.chance.within(1.5);
                let mut place = writer.move_to_next();
                place.extend([turn.sin(), 0.0, turn.cos()]);
                let numbers: Vec<String> =
                    place.iter().map(|value| format!("{value:.7}")).collect();
                writer.text += &format!("GOTO/{}\n", numbers.join(","));
            }
            _ => {
                let place = writer.move_to_next();
                writer.goto("GOTO", &place);
            }
        }
    }
    writer.text += "FINI\n";
    match writer.chance.below(3) {
        0 => writer.text.replace('\n', "\r\n"),
        _ => writer.text,
    }
}
