//! Codes of 04: legalization.

macro_rules! legalization_codes {
    ($($rows:tt)*) => {
        emission_codes! { $($rows)*
    "0401" NoEquivalent Error "the target control has no such function"
"The target control does not have the function, and no emulation gives it exactly. The message names the function and the reason."

    "0402" NearlyEqual Review "equivalent within a bound"
"The target does not have the function, or has it with another range. The conversion emulates it, within the domain or the error bound that the message names.

Check that the program stays in the domain, and that the part tolerates the error."

    "0403" OutOfRegisters Error "no register left"
"Every variable that programs share needs a register of its own on the target; values in between and locals share theirs as far as they are not needed at once. The target, as the machine profile describes it, has too few, too few of the kind that words take, or too few in a row for variables with computed numbers. The message says what has them. Of a library that needs too many, the program that alone uses the most is set aside, and refused, until the others have theirs. A program that calls itself is told here too, if a value must outlive the call and has one register for all levels.

Shorten the profile's `reserved` list, get the option for more variables, or convert a smaller library."

    "0404" OtherRetention Review "a variable lives longer or shorter"
"A variable keeps its value over power-off on one control and loses it on the other, and the program reads it before it writes it.

If nobody relies on the value from before power-off, nothing needs to be done: write \"power.off.values\" = \"unused\" under [behaviours] in the profile of the source's machine. It is asked once for the library. With \"used\" each program that reads such a variable first is for review; move it by hand to a register that lasts as long as on the source."

    "0405" Conditional Review "equivalent only if this holds on your machine"
"The target does the same only if something is true that the programs do not say: what the operator does at a stop, how inputs are wired, which unit the control is set to. The message names it.

Check it on the machine. If a machine profile can state it, state it there. If the answer is the same for all programs, such as flood coolant for mist, it is asked once for the library, and no program is for review because of it."

    "0406" MessageCut Note "message is cut"
"The target shows fewer characters of a message than the source. The message is cut, and a comment beside it has the whole text."

    "0407" LettersReplaced Note "letters are replaced"
"A message, a line of output or a comment has letters or signs that the target is not known to show, such as accented ones. Similar ones take their place: UE for Ü, C for Ç, EUR for €. Round brackets inside a message become square ones, and a per cent sign becomes PCT. This is reported once per program, at the first of them.

Nothing needs to be done. If a letter of a message has no substitute, MG0507 says so."

    "0408" NameInText Note "a text may name a variable that moved"
"A comment or a message has a number that may be the name of a variable, or may count something: `TOOL #5`. The variable has another register on the target. Where the text is clear about it (`SET #500`, `#5 = DEPTH`), the name of the register takes its place; here it is not clear, and the text stays as it is. This is reported once per program, at the first of them.

Read the text. If it means the variable, change it at the machine, or write `=` or `IS` after the name in the source."

    "0409" QualityDropped Note "a mode of quality is dropped"
"The block sets how smoothly or how fast the control follows a path: advanced preview, AI contour control, accuracy. Such a mode moves the tool to no other place, beyond the tolerance that the control is set to, and no code of the target means the same. It is left out, and told once a program. A limit on reading ahead is told so too, where the program reads and writes nothing that reading ahead could change.

Nothing needs to be done for the shape of the part. Where surface or speed matter, choose the mode of the target by its own codes or settings."

    "0410" NamesDropped Note "names of variables are dropped"
"The program gives names to variables (SETVN), which the source's control shows beside their values. The target shows no such names, and nothing else reads them. They are left out, and told once a program.

Nothing needs to be done. Tell the operator which register on the target holds what, if somebody looks at the values there: the report lists the registers."

    "0411" WrittenOut Note "the source does more than its words say"
"The control of the source makes a move here that no word of the block names, such as the turning pass in force once more for coolant alone. The target does not, so the move is written out.

Nothing needs to be done if the program cuts as it should on the source. If the move was never meant, take it out there: end the pass with G0 before the block."

    "0412" CycleWrittenOut Note "a cycle is written out"
"The cycle takes a length from a setting of the target: how far a peck goes back, what is left of a thread for its last pass. The target's profile states this setting, and the program needs another value, or two cycles of the program need different values. The moves of the cycle stand in its place, so that the machine does the same whatever it is set to.

Nothing needs to be done. To keep the cycle, set the machine as the message says, and write the value into its profile."

    "0413" TurnsWrittenOut Note "a feed per turn is written per minute"
"The target has no feed per turn. The feed is written per minute: so much a turn, times the speed that the program gives the spindle. It is told once a program.

Nothing needs to be done. While the operator turns the override of the spindle, the feed stays as it is, and the chip gets thinner or thicker."

    "0414" ShiftCounted Note "a local shift is counted into the coordinates"
"The target has no local shift (G52). The shift is added to the absolute coordinates of the blocks that it is in force for, and its blocks go. The machine goes to the same places; they are written in the coordinates of the work offset. Where a word may count with one of several shifts, as in a part that is called under each of them, a register holds the shift that was set last, and is added.

Nothing needs to be done. To move such a group of cuts on the target, change the coordinates, or give it a work offset of its own."

    "0415" AlwaysGiven Note "every call gives an argument"
"The program asks whether an argument was given, and every call in the library gives it. Calls of the target give no arguments: they set registers, which are never without a value. So what the program does without the argument (a value of its own, an alarm) is left out.

Nothing needs to be done for the programs of the library. Who writes a new call for the target must set each of these registers before it. The head of the converted program says which they are. To keep the check, convert the library together with a program that leaves the argument out."

    "0416" LeftByOthers Note "read after a program that is not in the library"
"A variable keeps its value over power-off on one control and loses it on the other. The program reads it before it writes it, but only after it called a program that is not in the library, as a probing macro that stands in both machines. The value is taken for the result of that program, so what an earlier run left there does not count.

There is nothing to do where the program called sets the variable. Where a value from before power-off is meant, write \"power.off.values\" = \"used\" under [behaviours] in the profile of the source's machine: each program that reads such a variable first is for review then."

    "0418" PlaceMoved Note "a place of the old machine lies elsewhere on the new one"
"The program moves to a place in machine coordinates. The profile of the target's machine says under 'machine_places' where that place lies there, and the move gets those words. It is told once a program. Both programs are compared as if the old one named the new place.

Nothing needs to be done. Whoever wrote the line has looked at the way there: the block before it, and what stands on the table, are the new machine's."

    "0419" DoesNothing Note "a code that does nothing here is left out"
"The block has a code that changes nothing where it stands: the code of a turning pass without a place (`G90` in the safe line of a lathe), before the first code that says how to move; the end of polar coordinates that no program of the library begins; a T that only makes a tool ready, for a machine whose T changes the tool. On the target it would not be sure to do nothing, or the target has no such code. It is told once a program.

Nothing needs to be done."

    "0420" RapidForFeed Note "a feed in machine coordinates is rapid on the new machine"
"The program moves in machine coordinates under a code that feeds, or under one that is not known. The old machine may feed there, the new one makes every such move by rapid. The profile of the target's machine says that rapid will do (\"machine.move.feed\" = \"rapid\" under [behaviours]). It is told once a program. Both programs are compared as if the old machine moved so too.

Nothing needs to be done. Whoever wrote the line answers for the way: nothing may stand in it that only a feed may touch."
        }
    };
}

pub(super) use legalization_codes;
