//! Expressions of macros: `[#1 * SIN[30] + #<depth>]`.
//!
//! Takes the bytes of a line; gives trees, and their values with the parameters of the moment. Operators, their order
//! (`**`; `* / MOD`; `+ -`; comparisons; `AND OR XOR`; each from left to right) and functions are those of LinuxCNC
//! (`docs/src/gcode/overview.adoc`, "Expressions", "Binary Operators", "Functions"), which has all of Fanuc's.

pub(crate) mod evaluate;
pub(crate) mod parse;

/// An expression that was read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Expression {
    Number(f64),
    /// The value of a parameter.
    Parameter(Box<Parameter>),
    /// 1 if a parameter has a value, 0 if not.
    Exists(Box<Parameter>),
    Negative(Box<Self>),
    Function(Function, Box<Self>),
    /// `ATAN[y]/[x]`.
    ArcTangent(Box<Self>, Box<Self>),
    Operation(Operator, Box<Self>, Box<Self>),
    /// An operation with AND, OR or XOR beside others without brackets: LinuxCNC does it last, Fanuc has AND with `*`, OR and XOR with `+`.
    Unbracketed(Box<Self>),
}

/// A place that holds a value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Parameter {
    /// `#5`, `#[2 + #1]`, `##2`.
    Number(Expression),
    /// `#<name>`, in small letters without blanks; names that begin with `_` are the same everywhere.
    Name(String),
}

/// A function of one value; angles are degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Absolute,
    ArcCosine,
    ArcSine,
    Cosine,
    Exponential,
    /// `FIX`: the next whole number below.
    Floor,
    /// `FUP`: the next whole number above.
    Ceiling,
    Logarithm,
    Round,
    Sine,
    SquareRoot,
    Tangent,
}

impl Function {
    /// Functions by their names.
    pub const ALL: [(&'static str, Self); 12] = [
        ("ABS", Self::Absolute),
        ("ACOS", Self::ArcCosine),
        ("ASIN", Self::ArcSine),
        ("COS", Self::Cosine),
        ("EXP", Self::Exponential),
        ("FIX", Self::Floor),
        ("FUP", Self::Ceiling),
        ("LN", Self::Logarithm),
        ("ROUND", Self::Round),
        ("SIN", Self::Sine),
        ("SQRT", Self::SquareRoot),
        ("TAN", Self::Tangent),
    ];
}

/// Binary operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Power,
    Times,
    Divided,
    Modulo,
    Plus,
    Minus,
    Equal,
    NotEqual,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    And,
    Or,
    ExclusiveOr,
}

impl Operator {
    /// Operators by their spelling; a longer one stands before its own prefix.
    pub const ALL: [(&'static str, Self); 15] = [
        ("**", Self::Power),
        ("*", Self::Times),
        ("/", Self::Divided),
        ("MOD", Self::Modulo),
        ("+", Self::Plus),
        ("-", Self::Minus),
        ("EQ", Self::Equal),
        ("NE", Self::NotEqual),
        ("GT", Self::Greater),
        ("GE", Self::GreaterOrEqual),
        ("LT", Self::Less),
        ("LE", Self::LessOrEqual),
        ("AND", Self::And),
        ("OR", Self::Or),
        ("XOR", Self::ExclusiveOr),
    ];

    /// AND, OR or XOR.
    pub fn is_logical(self) -> bool {
        matches!(self, Self::And | Self::Or | Self::ExclusiveOr)
    }

    /// The higher is done first.
    pub fn precedence(self) -> u8 {
        match self {
            Self::Power => 5,
            Self::Times | Self::Divided | Self::Modulo => 4,
            Self::Plus | Self::Minus => 3,
            Self::Equal
            | Self::NotEqual
            | Self::Greater
            | Self::GreaterOrEqual
            | Self::Less
            | Self::LessOrEqual => 2,
            Self::And | Self::Or | Self::ExclusiveOr => 1,
        }
    }
}
