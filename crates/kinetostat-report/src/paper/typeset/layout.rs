//! Layout of pages: blocks one below the other, on as many pages as they need. Points, from the upper left corner.

use kinetostat_machining::Level;

use crate::paper::block::{Block, Contents, Remark};
use crate::paper::typeset::letters::{Letters, Weight};
use crate::paper::typeset::pictures::Picture;

/// A4.
pub(super) const WIDTH: f32 = 595.28;
pub(super) const HEIGHT: f32 = 841.89;
/// Room beside the text: the left side is punched.
pub(super) const LEFT: f32 = 62.0;
pub(super) const RIGHT: f32 = WIDTH - 48.0;
pub(super) const TOP: f32 = 66.0;
pub(super) const BOTTOM: f32 = 60.0;

/// Size of the text, and how far its lines are apart in parts of it.
pub(super) const SIZE: f32 = 9.0;
const SMALL: f32 = 8.0;
const LEADING: f32 = 1.38;
/// Width of names beside what is said of them.
const NAMES: f32 = 128.0;
/// Room of one signature.
const SIGNATURE: f32 = 50.0;
/// A heading with the head of a table of two lines and two rows below it.
const WITH_TABLE: f32 = 84.0;
/// A heading with the room above and below it.
const HEADED: f32 = 32.0;

/// Something on a page.
#[derive(Clone, Debug)]
pub(super) enum Mark {
    /// A line of text on its base line.
    Text {
        x: f32,
        y: f32,
        text: String,
        weight: Weight,
        size: f32,
        grey: u8,
    },
    /// A filled area.
    Area {
        x: f32,
        y: f32,
        width: f32,
        height: f32,
        colour: [u8; 3],
    },
    /// A drawing.
    Picture {
        at: [f32; 2],
        size: [f32; 2],
        picture: Picture,
    },
}

impl Mark {
    /// A thin line.
    pub(super) fn rule(x: f32, y: f32, to: f32) -> Self {
        Self::Area {
            x,
            y,
            width: to - x,
            height: 0.5,
            colour: [150; 3],
        }
    }
}

/// Sets blocks on pages.
pub(super) struct Setter<'a> {
    pub(super) letters: &'a Letters,
    pages: Vec<Vec<Mark>>,
    /// Upper end of what is free on the last page.
    pub(super) y: f32,
}

impl<'a> Setter<'a> {
    /// All pages of a paper.
    pub(super) fn pages(letters: &'a Letters, contents: &Contents) -> Vec<Vec<Mark>> {
        let mut setter = Self {
            letters,
            pages: vec![Vec::new()],
            y: TOP,
        };
        setter.text(&contents.kind, LEFT, RIGHT, SMALL, Weight::Regular);
        setter.y += 2.0;
        setter.text(&contents.title, LEFT, RIGHT, 15.0, Weight::Bold);
        setter.y += 6.0;
        let blocks = &contents.blocks;
        for (at, block) in blocks.iter().enumerate() {
            if let [
                Block::Heading(_),
                Block::Note(note) | Block::Paragraph(note),
                Block::Table(_),
                ..,
            ] = &blocks[at..]
            {
                // A table's heading and what is said of it stand on its page.
                let lines = setter.lines(note, RIGHT - LEFT, SMALL, Weight::Regular);
                setter.room(WITH_TABLE + SIZE * LEADING * lines.len() as f32);
            }
            if let [Block::Heading(_), Block::Signatures(all), ..] = &blocks[at..] {
                // Keeps the signatures on the page of their heading.
                setter.room(HEADED + SIGNATURE * all.len() as f32);
            }
            setter.block(block);
        }
        setter.pages
    }

    /// Goes on at the next page unless there is so much room.
    pub(super) fn room(&mut self, height: f32) {
        if self.y + height > HEIGHT - BOTTOM {
            self.pages.push(Vec::new());
            self.y = TOP;
        }
    }

    pub(super) fn put(&mut self, mark: Mark) {
        if let Some(page) = self.pages.last_mut() {
            page.push(mark);
        }
    }

    pub(super) fn lines(&self, text: &str, width: f32, size: f32, weight: Weight) -> Vec<String> {
        let text = self.letters.writable(text);
        self.letters.lines(&text, weight, size, width)
    }

    /// One line at a height.
    pub(super) fn line_at(&mut self, x: f32, top: f32, text: String, size: f32, weight: Weight) {
        self.put(Mark::Text {
            x,
            y: top + size,
            text,
            weight,
            size,
            grey: 0,
        });
    }

    /// Text between two sides, in lines.
    fn text(&mut self, text: &str, left: f32, right: f32, size: f32, weight: Weight) {
        for line in self.lines(text, right - left, size, weight) {
            self.room(size * LEADING);
            self.line_at(left, self.y, line, size, weight);
            self.y += size * LEADING;
        }
    }

    fn block(&mut self, block: &Block) {
        match block {
            Block::Heading(text) => {
                self.y += 10.0;
                // Keeps a heading from standing alone at the foot of a page.
                self.room(64.0);
                self.text(text, LEFT, RIGHT, 11.0, Weight::Bold);
                self.y += 2.0;
            }
            Block::Paragraph(text) => {
                self.text(text, LEFT, RIGHT, SIZE, Weight::Regular);
                self.y += 4.0;
            }
            Block::Note(text) => self.caption(text),
            Block::Verdict {
                level,
                word,
                sentences,
            } => self.verdict(*level, word, sentences),
            Block::Facts(facts) => {
                for (name, lines) in facts {
                    self.fact(name, lines);
                }
            }
            Block::Remarks(remarks) => {
                for remark in remarks {
                    self.remark(remark);
                }
            }
            Block::List(items) => {
                for item in items {
                    self.room(SIZE * LEADING);
                    self.line_at(LEFT, self.y, "–".to_owned(), SIZE, Weight::Regular);
                    self.text(item, LEFT + 10.0, RIGHT, SIZE, Weight::Regular);
                    self.y += 2.0;
                }
            }
            Block::Picture { svg, shows } => self.picture(svg, shows),
            Block::Table(table) => self.table(table),
            Block::Signatures(all) => self.signatures(all),
        }
    }

    /// Small print.
    pub(super) fn caption(&mut self, text: &str) {
        self.text(text, LEFT, RIGHT, SMALL, Weight::Regular);
        self.y += 4.0;
    }

    /// A name, and beside it what is said of it.
    fn fact(&mut self, name: &str, lines: &[String]) {
        let names = self.lines(name, NAMES - 8.0, SIZE, Weight::Regular);
        self.room(SIZE * LEADING * names.len() as f32);
        let top = self.y;
        for (index, line) in names.iter().enumerate() {
            let y = top + index as f32 * SIZE * LEADING;
            self.put(Mark::Text {
                x: LEFT,
                y: y + SIZE,
                text: line.clone(),
                weight: Weight::Regular,
                size: SIZE,
                grey: 90,
            });
        }
        let page = self.pages.len();
        for line in lines {
            self.text(line, LEFT + NAMES, RIGHT, SIZE, Weight::Regular);
        }
        let below_names = top + names.len() as f32 * SIZE * LEADING;
        if page == self.pages.len() && self.y < below_names {
            self.y = below_names;
        }
        self.y += 2.0;
    }

    /// A name with its size, and an explanation.
    fn remark(&mut self, remark: &Remark) {
        let said = match (remark.size.is_empty(), remark.text.is_empty()) {
            (false, false) => vec![remark.size.clone(), remark.text.clone()],
            (true, _) => vec![remark.text.clone()],
            (_, true) => vec![remark.size.clone()],
        };
        self.fact(&remark.name, &said);
        self.y += 2.0;
    }

    /// The verdict in a box.
    fn verdict(&mut self, level: Level, word: &str, sentences: &[String]) {
        let (left, right) = (LEFT + 12.0, RIGHT - 8.0);
        let lines: Vec<Vec<String>> = sentences
            .iter()
            .map(|sentence| self.lines(sentence, right - left, SIZE, Weight::Regular))
            .collect();
        let count: usize = lines.iter().map(Vec::len).sum();
        let height = 28.0 + count as f32 * SIZE * LEADING + 3.0 * lines.len() as f32;
        self.y += 6.0;
        // A box that no page holds goes on without its sides.
        let fits = height < HEIGHT - TOP - BOTTOM;
        if fits {
            self.room(height);
            self.frame(level, height);
        }
        self.y += 7.0;
        self.text(word, left, right, 12.0, Weight::Bold);
        self.y += 1.0;
        for sentence in lines {
            for line in sentence {
                self.room(SIZE * LEADING);
                self.line_at(left, self.y, line, SIZE, Weight::Regular);
                self.y += SIZE * LEADING;
            }
            self.y += 3.0;
        }
        self.y += 8.0;
    }

    fn frame(&mut self, level: Level, height: f32) {
        let (dark, light) = match level {
            Level::Good => ([26, 127, 55], [236, 247, 239]),
            Level::Analysis | Level::Unchanged => ([70, 90, 120], [239, 242, 247]),
            Level::Attention => ([179, 89, 0], [255, 244, 232]),
            Level::Stop => ([176, 0, 32], [255, 236, 238]),
        };
        let y = self.y;
        self.put(Mark::Area {
            x: LEFT,
            y,
            width: RIGHT - LEFT,
            height,
            colour: light,
        });
        self.put(Mark::Area {
            x: LEFT,
            y,
            width: 4.0,
            height,
            colour: dark,
        });
    }

    /// Room to write in, all of it on one page.
    fn signatures(&mut self, all: &[[String; 3]]) {
        self.room(SIGNATURE * all.len() as f32);
        for [who, name, signature] in all {
            let foot = self.y + SIGNATURE - 14.0;
            let sides = [(LEFT, 86.0), (LEFT + 100.0, 180.0), (LEFT + 294.0, 190.0)];
            let who = self.letters.writable(who);
            self.line_at(LEFT, foot - SIZE - 4.0, who, SIZE, Weight::Bold);
            for ((x, width), below) in sides.into_iter().skip(1).zip([name, signature]) {
                self.put(Mark::rule(x, foot, x + width));
                let below = self.letters.writable(below);
                self.line_at(x, foot + 2.0, below, 7.0, Weight::Regular);
            }
            self.y += SIGNATURE;
        }
    }
}

/// Largest height of a drawing.
const TALLEST: f32 = 360.0;

impl Setter<'_> {
    /// A drawing as wide as the text, or as tall as it may be, with what it shows below it on the same page.
    pub(super) fn picture(&mut self, svg: &str, shows: &str) {
        let Some(picture) = Picture::read(self.letters, svg) else {
            return;
        };
        let [width, height] = picture.size();
        let most = TALLEST.min(HEIGHT - TOP - BOTTOM - 60.0);
        let scale = ((RIGHT - LEFT) / width).min(most / height);
        let size = [scale * width, scale * height];
        self.y += 6.0;
        self.room(size[1] + 24.0);
        let x = LEFT + 0.5 * (RIGHT - LEFT - size[0]);
        self.put(Mark::Picture {
            at: [x, self.y],
            size,
            picture,
        });
        self.y += size[1] + 2.0;
        self.caption(shows);
    }
}
