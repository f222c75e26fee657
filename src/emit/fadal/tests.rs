//! What programs of the IR become.
