# From the text of src/f64 to that of f32, for build.rs and for scripts/header.sh: the header generator does not expand macros, so the text of one
# scalar is made of the other's. One `s/from/to/` or `s/from/to/g` a line, without special characters.
s/f64/f32/g
s/F64/F32/g
s/DBL_MAX (float: FLT_MAX)/FLT_MAX/
s/-DBL_MAX or FLT_MAX/-FLT_MAX or FLT_MAX/
s/u64; 577/u64; 289/
