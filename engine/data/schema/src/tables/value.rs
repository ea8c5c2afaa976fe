//! Types of values: how each is stored in Arrow, checked, written and read.

use arrow_array::builder::{
    BinaryBuilder, BooleanBuilder, FixedSizeListBuilder, Float32Builder, Float64Builder, Int64Builder, ListBuilder,
    StringBuilder, StructBuilder,
};
use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef};
use arrow_schema::{DataType, Field, Fields};
use cosfly_diagnose::plausible;
use std::sync::Arc;

/// Type of a column's values, apart from nullability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Text.
    Text,
    /// 64-bit integer.
    Integer,
    /// 64-bit float.
    Real,
    /// True or false.
    Flag,
    /// One of the named classes, stored as its number.
    Label(&'static [&'static str]),
    /// A fixed number of 64-bit floats.
    Reals(usize),
    /// A pixel box: left, top, right, bottom edge as 32-bit floats.
    Box,
    /// Any number of 64-bit floats.
    RealList,
    /// Any number of 32-bit floats.
    FloatList,
    /// Any number of 64-bit integers.
    IntegerList,
    /// Any number of texts.
    TextList,
    /// An image file.
    Image,
}

impl Kind {
    /// Arrow type.
    pub fn data_type(self) -> DataType {
        match self {
            Self::Text => DataType::Utf8,
            Self::Integer | Self::Label(_) => DataType::Int64,
            Self::Real => DataType::Float64,
            Self::Flag => DataType::Boolean,
            Self::Reals(length) => DataType::FixedSizeList(item(DataType::Float64), length as i32),
            Self::Box => DataType::FixedSizeList(item(DataType::Float32), 4),
            Self::RealList => DataType::List(item(DataType::Float64)),
            Self::FloatList => DataType::List(item(DataType::Float32)),
            Self::IntegerList => DataType::List(item(DataType::Int64)),
            Self::TextList => DataType::List(item(DataType::Utf8)),
            Self::Image => DataType::Struct(image_fields()),
        }
    }

    /// Type in words, for cards and reference pages.
    pub fn words(self) -> String {
        match self {
            Self::Text => "text".into(),
            Self::Integer => "int64".into(),
            Self::Real => "float64".into(),
            Self::Flag => "bool".into(),
            Self::Label(names) => format!("class label: {}", names.join(", ")),
            Self::Reals(length) => format!("float64[{length}]"),
            Self::Box => "float32[4]".into(),
            Self::RealList => "list of float64".into(),
            Self::FloatList => "list of float32".into(),
            Self::IntegerList => "list of int64".into(),
            Self::TextList => "list of text".into(),
            Self::Image => "image".into(),
        }
    }

    /// Whether the column has a Hugging Face feature; such columns are nullable for `datasets` to recognise them.
    pub fn is_featured(self) -> bool {
        matches!(self, Self::Label(_) | Self::Image)
    }
}

fn item(kind: DataType) -> Arc<Field> {
    Arc::new(Field::new("item", kind, true))
}

/// Images as Hugging Face stores them: a struct of file bytes and an empty path.
fn image_fields() -> Fields {
    Fields::from(vec![Field::new("bytes", DataType::Binary, true), Field::new("path", DataType::Utf8, true)])
}

/// A value of a column.
pub trait Value: Sized + 'static {
    /// Type in tables.
    const KIND: Kind;
    /// Whether rows may be null.
    const NULLABLE: bool = false;

    /// Rule that the value breaks, if any, such as that numbers are finite.
    fn problem(&self) -> Option<String> {
        None
    }

    /// Array of all values.
    fn array(values: Vec<Self>) -> ArrayRef {
        Self::array_of(values.into_iter().map(Some))
    }

    /// Array of all values, null for `None`.
    fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef;

    /// Value in a row of an array of [`Kind::data_type`]; `None` where the row holds no value of this type: null, NaN,
    /// a number out of range.
    fn read(array: &dyn Array, row: usize) -> Option<Self>;
}

impl<T: Value> Value for Option<T> {
    const KIND: Kind = T::KIND;
    const NULLABLE: bool = true;

    fn problem(&self) -> Option<String> {
        self.as_ref().and_then(T::problem)
    }

    fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
        T::array_of(values.map(Option::flatten))
    }

    fn read(array: &dyn Array, row: usize) -> Option<Self> {
        if array.is_null(row) { Some(None) } else { T::read(array, row).map(Some) }
    }
}

/// Violated rule where a number is none that a measurement can have: places, times, angles, pixels.
fn measured(values: impl IntoIterator<Item = f64>) -> Option<String> {
    values.into_iter().find_map(|value| plausible(value).err().map(|fault| format!("`{value:e}` {fault}")))
}

/// Violated rule where a float is not finite: of lists, such as costs, which have no unit.
fn finite(values: impl IntoIterator<Item = f64>) -> Option<String> {
    let wrong = values.into_iter().find(|value| !value.is_finite())?;
    Some(format!("`{wrong}` is not a finite number"))
}

macro_rules! plain_value {
    ($kind:ty, $name:expr, $builder:ty, |$value:ident| $stored:expr, |$array:ident, $row:ident| $read:expr $(, $problem:item)?) => {
        impl Value for $kind {
            const KIND: Kind = $name;

            $($problem)?

            fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
                let mut builder = <$builder>::new();
                values.for_each(|value| builder.append_option(value.map(|$value| $stored)));
                Arc::new(builder.finish())
            }

            fn read($array: &dyn Array, $row: usize) -> Option<Self> {
                $array.is_valid($row).then_some(())?;
                $read
            }
        }
    };
}

plain_value!(String, Kind::Text, StringBuilder, |value| value, |array, row| Some(
    array.as_string_opt::<i32>()?.value(row).to_owned()
));
plain_value!(bool, Kind::Flag, BooleanBuilder, |value| value, |array, row| Some(array.as_boolean_opt()?.value(row)));
plain_value!(i64, Kind::Integer, Int64Builder, |value| value, |array, row| {
    Some(array.as_primitive_opt::<Int64Type>()?.value(row))
});
plain_value!(u64, Kind::Integer, Int64Builder, |value| i64::try_from(value).unwrap_or(i64::MAX), |array, row| {
    u64::try_from(array.as_primitive_opt::<Int64Type>()?.value(row)).ok()
});
plain_value!(u32, Kind::Integer, Int64Builder, |value| i64::from(value), |array, row| {
    u32::try_from(array.as_primitive_opt::<Int64Type>()?.value(row)).ok()
});
plain_value!(
    f64,
    Kind::Real,
    Float64Builder,
    |value| value,
    |array, row| plausible(array.as_primitive_opt::<Float64Type>()?.value(row)).ok(),
    fn problem(&self) -> Option<String> {
        measured([*self])
    }
);

macro_rules! list_value {
    ($item:ty, $name:expr, $builder:ty, $type:ty, |$values:ident| $check:expr) => {
        impl Value for Vec<$item> {
            const KIND: Kind = $name;

            fn problem(&self) -> Option<String> {
                let $values = self;
                $check
            }

            fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
                let mut builder = ListBuilder::new(<$builder>::new());
                for value in values {
                    builder.append_option(value.map(|items| items.into_iter().map(Some)));
                }
                Arc::new(builder.finish())
            }

            fn read(array: &dyn Array, row: usize) -> Option<Self> {
                let lists = array.as_list_opt::<i32>().filter(|_| array.is_valid(row))?;
                let items = lists.value(row);
                let values =
                    items.as_primitive_opt::<$type>().filter(|items| items.null_count() == 0)?.values().to_vec();
                values.problem().is_none().then_some(values)
            }
        }
    };
}

list_value!(f64, Kind::RealList, Float64Builder, Float64Type, |values| finite(values.iter().copied()));
list_value!(f32, Kind::FloatList, Float32Builder, Float32Type, |values| finite(values.iter().map(|it| f64::from(*it))));
list_value!(i64, Kind::IntegerList, Int64Builder, Int64Type, |_values| None);

impl Value for Vec<String> {
    const KIND: Kind = Kind::TextList;

    fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
        let mut builder = ListBuilder::new(StringBuilder::new());
        values.for_each(|value| builder.append_option(value.map(|texts| texts.into_iter().map(Some))));
        Arc::new(builder.finish())
    }

    fn read(array: &dyn Array, row: usize) -> Option<Self> {
        let texts = array.as_list_opt::<i32>().filter(|_| array.is_valid(row))?.value(row);
        Some(texts.as_string_opt::<i32>()?.iter().map(|text| text.unwrap_or_default().to_owned()).collect())
    }
}

impl<const N: usize> Value for [f64; N] {
    const KIND: Kind = Kind::Reals(N);

    fn problem(&self) -> Option<String> {
        measured(*self)
    }

    fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
        let mut builder = FixedSizeListBuilder::new(Float64Builder::new(), N as i32);
        for value in values {
            match value {
                Some(numbers) => builder.values().append_slice(&numbers),
                None => builder.values().append_nulls(N),
            }
            builder.append(value.is_some());
        }
        Arc::new(builder.finish())
    }

    fn read(array: &dyn Array, row: usize) -> Option<Self> {
        let items = array.as_fixed_size_list_opt().filter(|_| array.is_valid(row))?.value(row);
        let numbers = Self::try_from(&items.as_primitive_opt::<Float64Type>()?.values()[..]).ok()?;
        (items.null_count() == 0 && numbers.problem().is_none()).then_some(numbers)
    }
}

/// Edges of a pixel box: left, top, right, bottom; the origin is the top-left corner of the image.
pub type Edges = [f32; 4];

impl Value for Edges {
    const KIND: Kind = Kind::Box;

    fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
        let mut builder = FixedSizeListBuilder::new(Float32Builder::new(), 4);
        for value in values {
            match value {
                Some(edges) => builder.values().append_slice(&edges),
                None => builder.values().append_nulls(4),
            }
            builder.append(value.is_some());
        }
        Arc::new(builder.finish())
    }

    fn read(array: &dyn Array, row: usize) -> Option<Self> {
        let items = array.as_fixed_size_list_opt().filter(|_| array.is_valid(row))?.value(row);
        let edges = Self::try_from(&items.as_primitive_opt::<Float32Type>()?.values()[..]).ok()?;
        edges.iter().all(|edge| plausible(f64::from(*edge)).is_ok()).then_some(edges)
    }
}

/// Bytes of an image file, such as JPEG.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageFile(pub Vec<u8>);

impl Value for ImageFile {
    const KIND: Kind = Kind::Image;

    fn array_of(values: impl Iterator<Item = Option<Self>>) -> ArrayRef {
        let children: Vec<Box<dyn arrow_array::builder::ArrayBuilder>> =
            vec![Box::new(BinaryBuilder::new()), Box::new(StringBuilder::new())];
        let mut builder = StructBuilder::new(image_fields(), children);
        for value in values {
            builder.append(value.is_some());
            builder.field_builder::<BinaryBuilder>(0).expect("field 0 is binary").append_option(value.map(|it| it.0));
            builder.field_builder::<StringBuilder>(1).expect("field 1 is text").append_null();
        }
        Arc::new(builder.finish())
    }

    fn read(array: &dyn Array, row: usize) -> Option<Self> {
        let bytes = array.as_struct_opt().filter(|_| array.is_valid(row))?.column_by_name("bytes")?;
        let bytes = bytes.as_binary_opt::<i32>().filter(|_| bytes.is_valid(row))?;
        Some(Self(bytes.value(row).to_vec()))
    }
}

/// One of a few named classes, stored as the index of its name.
macro_rules! class_value {
    ($class:ty, $all:expr, $names:expr) => {
        impl $crate::tables::Value for $class {
            const KIND: $crate::tables::Kind = $crate::tables::Kind::Label(&$names);

            fn array_of(values: impl Iterator<Item = Option<Self>>) -> arrow_array::ArrayRef {
                let number = |class: Self| $all.iter().position(|it| *it == class).unwrap_or_default() as i64;
                <i64 as $crate::tables::Value>::array_of(values.map(|value| value.map(number)))
            }

            fn read(array: &dyn arrow_array::Array, row: usize) -> Option<Self> {
                let number = <i64 as $crate::tables::Value>::read(array, row)?;
                $all.get(usize::try_from(number).ok()?).copied()
            }
        }
    };
}
pub(super) use class_value;
