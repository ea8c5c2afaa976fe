//! [`Tensor`]: numbers with a shape.

/// Kind of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 32-bit floats.
    Float,
    /// Whole numbers and flags.
    Whole,
}

impl Kind {
    /// The kind of ONNX's number of an element type.
    ///
    /// # Errors
    /// A type that is not read, in words.
    pub fn of(element: i64) -> Result<Self, String> {
        match element {
            1 => Ok(Self::Float),
            2 | 3 | 6 | 7 | 9 => Ok(Self::Whole),
            other => {
                let name = NAMES.iter().find(|(number, _)| *number == other).map_or("unknown", |it| it.1);
                Err(format!(
                    "the element type {name} ({other}) is not read; allowed are float32, uint8, int8, int32, int64, bool"
                ))
            }
        }
    }
}

/// Names of element types that are not read.
const NAMES: [(i64, &str); 10] = [
    (0, "undefined"),
    (4, "uint16"),
    (5, "int16"),
    (8, "string"),
    (10, "float16"),
    (11, "float64"),
    (12, "uint32"),
    (13, "uint64"),
    (16, "bfloat16"),
    (17, "float8"),
];

/// Numbers of a tensor, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum TensorValues {
    /// 32-bit floats.
    Floats(Vec<f32>),
    /// Whole numbers; flags are 0 and 1.
    Wholes(Vec<i64>),
}

impl TensorValues {
    /// Kind of the numbers.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Floats(_) => Kind::Float,
            Self::Wholes(_) => Kind::Whole,
        }
    }

    /// Count of the numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::Floats(values) => values.len(),
            Self::Wholes(values) => values.len(),
        }
    }

    /// Count of the numbers, where whole numbers count twice: they take twice the memory.
    pub fn held(&self) -> usize {
        match self {
            Self::Floats(values) => values.len(),
            Self::Wholes(values) => 2 * values.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers at places, which must be there.
    pub fn pick(&self, places: impl Iterator<Item = usize>) -> Self {
        match self {
            Self::Floats(values) => Self::Floats(places.map(|place| values[place]).collect()),
            Self::Wholes(values) => Self::Wholes(places.map(|place| values[place]).collect()),
        }
    }
}

/// Numbers with a shape. A scalar has the shape `[]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// Sizes of the axes; their product is the count of the values.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: TensorValues,
}

impl Tensor {
    /// Floats of a shape.
    pub fn floats(shape: &[usize], values: Vec<f32>) -> Self {
        Self { shape: shape.to_vec(), values: TensorValues::Floats(values) }
    }

    /// Whole numbers of a shape.
    pub fn wholes(shape: &[usize], values: Vec<i64>) -> Self {
        Self { shape: shape.to_vec(), values: TensorValues::Wholes(values) }
    }

    /// Zeros of a kind and a shape.
    pub fn zeros(kind: Kind, shape: &[usize]) -> Self {
        let count = shape.iter().product();
        match kind {
            Kind::Float => Self::floats(shape, vec![0.0; count]),
            Kind::Whole => Self::wholes(shape, vec![0; count]),
        }
    }
}

/// Most axes of a tensor.
pub const MOST_AXES: usize = 8;
/// Most numbers of a tensor.
pub const MOST_NUMBERS: usize = 1 << 24;

/// Count of the numbers of a shape; none beyond [`MOST_NUMBERS`], where empty axes count as one: so no product of sizes overflows.
pub fn count(shape: &[usize]) -> Option<usize> {
    let product = |count: usize, size: &usize| count.checked_mul((*size).max(1)).filter(|count| *count <= MOST_NUMBERS);
    let most = shape.iter().try_fold(1, product)?;
    Some(if shape.contains(&0) { 0 } else { most })
}

/// The first numbers of a list, for errors: it may have millions.
pub fn listed(list: &[impl core::fmt::Debug]) -> String {
    match list.split_at_checked(MOST_AXES) {
        Some((first, rest)) if !rest.is_empty() => format!("{first:?} and {} more", rest.len()),
        _ => format!("{list:?}"),
    }
}

/// Steps from one number to the next along each axis.
pub fn strides(shape: &[usize]) -> Vec<usize> {
    let mut strides = vec![1; shape.len()];
    for axis in (1..shape.len()).rev() {
        strides[axis - 1] = strides[axis] * shape[axis];
    }
    strides
}

/// Places of the numbers of a shape in another tensor, row by row, where each axis has a step of its own.
pub fn places(shape: &[usize], steps: &[isize], first: usize) -> impl Iterator<Item = usize> + use<> {
    let (shape, steps) = (shape.to_vec(), steps.to_vec());
    let count = shape.iter().product::<usize>();
    let mut at = vec![0_usize; shape.len()];
    let mut place = first as isize;
    (0..count).map(move |_| {
        let now = place as usize;
        for axis in (0..shape.len()).rev() {
            at[axis] += 1;
            place += steps[axis];
            if at[axis] < shape[axis] {
                break;
            }
            place -= steps[axis] * shape[axis] as isize;
            at[axis] = 0;
        }
        now
    })
}
