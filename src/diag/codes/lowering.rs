//! Codes of 03: lowering.

macro_rules! lowering_codes {
    ($($rows:tt)*) => {
        legalization_codes! { $($rows)*
    "0301" NotUnderstood Error "unknown meaning"
"The block can be read, but the table of its control has no meaning for this word or statement. Nothing is guessed: the program is refused.

If a machine builder defined the word, give its meaning in the machine profile."

    "0310" TargetMissing Review "no block has this label"
"A jump goes to a sequence number or a label that no block of the program has, or a call to a subroutine that the program has not. The control stops with an alarm when it gets there, and the converted program does the same. If the jump is never made, the program runs as before.

Correct the jump or add the label, if it is meant to be made."

    "0311" TargetTwice Review "several blocks have this sequence number"
"A jump goes to a sequence number that more than one block of the program has. The conversion takes the block that the control finds by its table, or the first one if no source says which. The message names its line.

Give the blocks different numbers."

    "0312" ModalConflict Error "modal state depends on the path"
"The meaning of the block depends on what was set before it: the motion mode, the angle unit, the places of rounding. The paths to this block set different ones, or none is known, so no single translation is right.

State it in the block or just before it."

    "0313" ModalAssumed Review "uses a mode set outside the program"
"The block depends on a mode that the program did not set itself: its caller set it, or a program that it called. The conversion supposes that a called program leaves the mode as it was, and that the caller is not in an arc mode.

State the mode in the block, or check the programs that are named."

    "0314" EarlyRead Review "may be read before earlier moves are done"
"The control reads ahead: a statement that reads a position, an input or a counter may get its value from before the last moves. The conversion has a wait before it where the target reads ahead too, so it reads it after they are done. If the program means that too, nothing changes. Where no wait can be written, as under cutter compensation on some targets, each such place is reported, and says so: there the target may read an old value.

If the program means the value after the moves, put a wait before the statement; cancel the compensation first where that is reported."

    "0315" Indexer Error "sends code to the maker's indexer"
"The statement sends text to a device that only this maker's controls have. The text has no meaning elsewhere.

Program the axis directly."

    "0316" FixedSubroutine Review "calls a fixed subroutine of the maker"
"The maker keeps the subroutine in the control. It is not part of the library, so no program here shows what it does, and other makers' controls do not have it.

Write the routine as a program of the library."

    "0317" SpeedRange Review "a fraction of the spindle speed picks a belt range"
"On this control the digit after the point of a spindle speed is not part of the speed: it picks the belt range. The speed is converted without it, and the target picks the range by the speed. It is told once for the library.

Check that the target has the torque for slow heavy cuts in the range that it picks."

    "0318" SubroutineArea Error "the subroutines at the head are not closed"
"The program defines subroutines at its head, but the code that ends their area is missing, so it is not known where its main part begins.

Add the code that closes the area."

    "0319" SubroutineLeft Review "a subroutine is left without its end"
"A jump goes out of a subroutine or into one, or a subroutine runs into the end of its area. No source says what the control does with the return that is still open.

End the subroutine by its own code, and jump within it only."

    "0330" RegisterUnset Error "the condition register is not set here"
"The jump looks at the condition register. On one path to it nothing has set the register, neither arithmetic nor a test, or a cycle ran in between and may have changed it. No source says what it holds then.

Test the variable that is meant just before the jump."

    "0331" CodeByVariable Review "a variable gives the code"
"The G or M code, or the label, comes from a variable. Every assignment to that variable in the program gives it the same number, and the conversion uses that number. It does not check whether another program or the operator changes the variable.

Write the code itself, or check that nothing else writes the variable."

    "0343" ArgumentsMixed Error "arguments of both kinds are mixed"
"The call has repeated or unordered I, J and K, which count by place, and also letters that have locals of their own. This control takes one kind in a call. It is not known what it does with both.

Use each letter once, in order, or only A, B, C and sets of I, J, K."

    "0344" RepeatKeepsLocals Review "repeats of a call do not set its arguments again"
"This control sets the arguments before the first pass only. Each later pass begins with the locals as the pass before left them, so a macro that changes its arguments runs differently the second time.

Check whether the macro assigns to its arguments. If it does not, nothing changes."

    "0345" SkipUnclear Error "unclear block skip"
"The block-skip sign is before a block that begins or ends a loop, and not before every block of that loop, or it stands twice in its block. It is not certain what the control then skips.

Put the same block skip before every block of the loop, from its head to its end, and other words to be skipped into a block of their own. No jump or return may come into such a loop elsewhere than at its head."

    "0346" ThenMissing Review "THEN is missing"
"A statement follows the condition without THEN. Some programs are written so, but the maker's text does not have this form. The conversion supposes that the statement runs when the condition holds.

Write THEN before the statement."

    "0347" OutputBlank Review "a blank in formatted output"
"The text that the program puts out has a blank in it. Some controls leave blanks out; only '*' is certain to print one. The conversion prints the blank.

Write '*' for each blank that must be printed."

    "0348" NotWritable Error "cannot be assigned to"
"The variable is read-only. The control stops with an alarm at the assignment."

    "0349" LatheProgram Error "looks like a lathe program"
"The block looks like one for a lathe: the table for mills gives this word another meaning, or none. Read as a mill program, it would make moves that nobody meant.

The programs that this one calls or that call it, those of its file, and in a library without mill programs all others, count as lathe programs too, unless their own text is a mill's (Y, a length offset, M6). The message names the file and line where the sign was seen.

A library in which some programs look like a lathe's and none like a mill's is read as a lathe's if its profile says no kind of machine; a note names the sign. This code is for what is left: libraries of both kinds, and profiles that say 'machine = \"mill\"'.

Name a machine profile with 'machine = \"lathe\"', or with 'machine = \"mill\"' if the program is for a mill after all. Programs of two machines in one folder can be two libraries of macroglot.toml: 'only' and 'except' say which files are of which."

    "0350" ComputedCode Note "computed code"
"The number of the G or M code is computed, so its meaning depends on the value when the program runs. Only a control with the same codes can do the same. A code that ends or calls a program is not followed.

Write the codes out, each after its condition."

    "0351" GroupTwice Review "two codes of one group in a block"
"Codes of one group exclude each other. On most controls the last one of the block counts; both are converted in their order.

Leave one of them out."

    "0352" WordTwice Review "a word stands twice in its block"
"Two words of the block mean the same thing. On most controls the last one counts; both are converted in their order.

Leave one of them out."

    "0353" MCodes Review "more M codes than the control takes"
"The block has more M codes than its control accepts in one block. The control may stop with an alarm, or do only some of them.

Put each into a block of its own."

    "0354" WholeWithPoint Review "a decimal point in a whole-number word"
"The word takes a whole number, and some controls stop with an alarm at a decimal point in it. The number is converted without the point.

Leave the point out."

    "0355" WordsBesideCall Review "words beside the end of a modal call"
"No source says whether the words of this block act before the modal call ends or after it. The conversion takes them to act after it.

Put them into a block of their own."

    "0356" CodeSystem Error "of another G code system"
"A lathe's control is set to one of several G code systems, in which the same code means different things: G90 is a turning pass in one and absolute coordinates in another. The profile does not say which, so the programs are read by the usual one. The message names a code that this system has not, or not so. All programs of the library are for one machine, so all of them are refused, also those without such a code.

Write the system into the machine profile: 'gcode_system' under [settings]. The control's parameters show it."

    "0357" TwoPaths Error "one of several programs that run at the same time"
"A lathe with two turrets or two spindles may run two programs at once, which wait for each other at M codes with P. What each does depends on where the other one is, and macroglot converts programs that run alone. The message names the block that shows the second path; nothing else is said of the program.

Convert what one path does alone, as a program of its own, without the blocks that wait. If the code means something else on this machine, say so in the machine profile: [[site]]."

    "0358" NeverRun Note "a block that cannot be read is never run"
"The block comes after the end of the program, or after a jump, with no sequence number in between. The machine never gets to it, and the program does the same without it. The conversion leaves it out.

Correct the block or take it out, if it is meant to be run."
        }
    };
}

pub(super) use lowering_codes;
