//! Options, changed field by field.

/// One function `with_FIELD` for each of some fields: outside this crate options are their defaults with changes.
macro_rules! with_fields {
    ($options:ty { $($with:ident: $field:ident as $type:ty),* $(,)? }) => {
        impl $options {
            $(
                #[doc = concat!("These options with [`Self::", stringify!($field), "`] changed.")]
                #[must_use]
                pub fn $with(self, $field: $type) -> Self {
                    Self { $field, ..self }
                }
            )*
        }
    };
}

pub(crate) use with_fields;
