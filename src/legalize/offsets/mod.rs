//! Work offsets, tool lengths and positions.

pub(in crate::legalize) mod active_offsets;
pub(in crate::legalize) mod arc_starts;
pub(in crate::legalize) mod argument_offsets;
pub(in crate::legalize) mod external;
pub(in crate::legalize) mod folded_shifts;
pub(in crate::legalize) mod kept_length;
pub(in crate::legalize) mod kept_radius;
pub(in crate::legalize) mod known_tools;
pub(in crate::legalize) mod later_lengths;
pub(in crate::legalize) mod left_shifts;
pub(in crate::legalize) mod length_radius;
pub(in crate::legalize) mod missing_length;
pub(in crate::legalize) mod named_lengths;
pub(in crate::legalize) mod no_shifts;
pub(in crate::legalize) mod offset_numbers;
pub(in crate::legalize) mod offset_rows;
pub(in crate::legalize) mod one_table;
pub(in crate::legalize) mod position_length;
pub(in crate::legalize) mod radius_words;
pub(in crate::legalize) mod set_position;
pub(in crate::legalize) mod still_blocks;
pub(in crate::legalize) mod table_writes;
pub(in crate::legalize) mod tool_groups;
pub(in crate::legalize) mod tool_lengths;
pub(in crate::legalize) mod tool_word;
pub(in crate::legalize) mod written_tools;
