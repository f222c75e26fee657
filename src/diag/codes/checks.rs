//! Codes of 09: checks.

macro_rules! checks_codes {
    ($($rows:tt)*) => {
        codes! { $($rows)*
    "0901" BytesLost Error "reading loses bytes"
"What was read of the file does not print as it stands there, byte for byte. Conversions of it could lose something too.

Please report the file: this is a fault of macroglot."

    "0902" RoundRefused Error "a program does not come through a round trip"
"The project file asks that each program can go to another machine and come back. This one is refused on the way there, or on the way back. The message has the first reason.

Correct the place that is shown, add what is missing to a machine profile, or allow the finding under `[checks]` in the project file, with the reason."

    "0903" RoundDiffers Error "a round trip changes what the machine does"
"The program was converted for another machine, or back from it, and both were run on emulated controls: they do not do the same. Nothing is known to be wrong with the program.

Please report the program: the fault is in macroglot or in the table of a control."

    "0904" RoundUndecided Review "a round trip is not verified"
"The program went to another machine and came back, and no difference was found. But part of it was not decided: a branch that no run reached, a fact that no manual confirms. The check tells of it only if it is asked to.

Answer what the message asks in a machine profile. To be told of all such programs, put the code into `extend_select` under `[checks]`."

    "0905" RoundUnstable Review "the text changes in a second round"
"The program went to another machine and came back, and what came back goes the way again. It comes back as another text than the first time, so each round makes changes for a reviewer to read. All of them do the same.

Commit the text that came back as the program, and convert from there; or allow the finding under `[checks]`."

    "0906" ConversionStale Error "a conversion is not of the text that stands there"
"The program, one that it calls, or a machine profile changed after the conversion was made. What the machine runs is another program than the library has.

Run `macroglot convert`, read what changed with `macroglot diff`, and commit the conversion with its source."

    "0907" ConversionMissing Error "a program was never converted"
"The project file names a folder for conversions of this library, others stand there, and this program was not among those that were converted.

Run `macroglot convert`."

    "0908" ConversionChanged Review "a conversion was changed by hand"
"The text in the output folder is not the one that macroglot wrote. Its certificate is about another text, and the next conversion puts it aside.

Make the change in the source or in the machine profile, and convert again."

    "0909" SourceGone Review "a conversion has no source"
"The program that this conversion was made of does not stand in the library any more. The machine would still run it.

Run `macroglot convert --prune`, which removes it, or bring the source back."

    "0910" SignedStale Error "a signed report is about other files"
"Somebody signed this report. A program, a conversion or a profile that it is about has changed since.

Have the change read and signed: write a new report with `macroglot convert --report`, or take the file back to what was signed."

    "0920" UnsetLocal Review "a local is read before it is set"
"On some way through the program nothing has given the local a value. A word whose value is vacant is as if it were not written: a spindle then turns at the last speed that was named, which has killed an operator. In arithmetic the local counts as 0.

Set the local before it is read, or ask whether it is vacant and stop with an alarm if it is."

    "0921" MissingArgument Review "a call leaves out an argument that is read"
"The called program reads the local of this argument without asking whether it has a value, and the call does not give it. A word with it is then as if it were not written; in arithmetic it counts as 0.

Give the argument, or let the called program ask for it: set it to what is meant, or stop with an alarm."

    "0922" UnreadArgument Note "an argument is given that nobody reads"
"The called program never reads the local that this argument sets. Perhaps the letter is wrong, or the program was changed and the call was not.

Look up which letter sets which local, and take the argument out if nobody needs it."

    "0923" LeftChanged Review "a call changes a local of its caller"
"The called program has no locals of its own here: it uses those of its caller. It sets one that the caller has set before and reads afterwards, and the called program does not read it first, so it does not seem to be meant for both.

Use another local in the called program, or call it with locals of its own."

    "0924" NeverRead Note "a value is set and never read"
"Neither the program nor what it calls with the same locals reads this local. Perhaps the place that should read it names another variable.

Look for the place that should read it, or take the assignment out."

    "0925" Overwritten Note "a value is replaced before it is read"
"The same variable gets another value a few blocks later, and nothing between the two reads it. Perhaps one of the two numbers is wrong.

Look at both variables, and take out the assignment that is not needed."

    "0926" UnusedLabel Note "a label is not used"
"No jump and no call of the program names this label. Perhaps a jump names another one by mistake. Sequence numbers are looked at only in programs that jump and that number few of their blocks.

Look for the jump that should go here, or take the label out."

    "0927" Unreached Note "a block is never run"
"Nothing leads to this block: a jump, a return or an end stands before it, and no jump or call goes to it.

Take the block out, or look for the jump that should go to it."

    "0928" EndlessLoop Review "a loop does not end"
"Nothing leaves the loop, or what decides whether it ends depends on variables that nothing in it changes. The machine repeats it until somebody stops it. A loop in which the program stops for the operator is not meant here.

Change in the loop what its condition looks at."

    "0929" JumpToNext Note "a jump goes to the next block"
"The program goes on at the same block with the jump and without it. Perhaps blocks between the two were taken out, or the jump should go elsewhere.

Take the jump out, or name the block that is meant."

    "0930" EndMissing Review "a program has no end"
"The text of the program ends without a code that ends the run or returns. What the control does then is its own affair: it may stop with an alarm, or run the next program in its memory.

End the program with the code for its end, or with a return if others call it."

    "0931" SequenceTwice Note "a sequence number stands twice"
"Two blocks of the program have this sequence number. A jump to it goes to one of them; which one depends on the control and on where the jump stands (MG0311 says so where a jump is). The makers call this very dangerous.

Give one of the blocks another number. The rule is off unless it is asked for: many shops number by hand and never jump."

    "0932" CallsTooDeep Review "calls go too deep"
"The calls that lead here are as many as the control has levels, and this is one more: the control stops with an alarm.

Call less deeply. If the limit is wrong for your control, put the right one under [limits] in the machine profile."

    "0933" EndlessCalls Review "a program calls itself and never ends"
"Every way through the program calls it once more before it ends. The control stops with an alarm when its levels are used up.

Let a condition end it, or jump where a call is not needed."

    "0934" MissingProgram Review "a called program is not in the library"
"The program calls one that no file of the library has. The control stops with an alarm if it is not in its memory either.

Add the program's file to the library. If it stays in the machine, and nowhere else, say in the project file that this finding is not wanted there."

    "0935" FileNumber Note "file and program have different numbers"
"The name of the file begins with a program number, and no program in it has that number. Whoever loads the file by its name gets another program into the control, perhaps over one that is needed.

Rename the file, or correct the number."

    "0936" EqualComputed Review "a computed value is compared for equality"
"What arithmetic with fractions comes to is off in its last digits: ten times 0.1 need not be 1. A comparison for equal may fail where it should hold, and a loop that waits for it runs on.

Compare for less or greater, round before the comparison, or compare the difference with a tolerance."

    "0937" VacantOrder Review "a comparison with vacant for less or greater"
"Only comparisons for equal and not equal can tell whether a variable has a value. For less and greater vacant counts as 0.

Compare for equal or not equal, or write 0 if 0 is meant."

    "0938" ConstantCondition Note "a condition never changes"
"The condition holds always, or never, whatever values the variables have. Seminars of the makers advise to check of each compound condition that it can be true and can be false.

Look at the signs and at AND and OR. A test that was left in the program can be taken out."

    "0939" UnsetDivisor Review "a division by a variable that nothing sets"
"Nothing in the library sets this variable, and nothing asks for its value before. If the operator does not set it by hand, it is vacant or 0, and a division by it stops the machine with an alarm.

Set it, or ask whether it is vacant or 0 first."

    "0940" OpenSubscript Review "a computed variable number has no bound"
"The number of the variable is computed, and nothing in the program says how small or large it may become. A wrong value writes into another variable, and on some controls into offsets or parameters.

Compare the number with the least and the greatest that are meant before it is used."

    "0941" RoundForFix Review "a remainder is made with rounding"
"The remainder of a division is what is left over the whole number below. With the nearest whole number it is negative for half of all values: 7 in steps of 10 gives -3.

Use the function that cuts the fraction off."

    "0942" BareLength Review "a length has no decimal point"
"On this control a length without a decimal point counts least increments, so that 10 is 0.010 mm. The program writes most of its lengths with a point, and this one without.

Write the point. If the control reads such numbers as whole units, put `decimal_point = \"calculator\"` into the machine profile."

    "0943" UncheckedSpeed Review "a spindle speed is not checked"
"The spindle speed comes from an argument or a variable that the program does not set itself, and no comparison bounds it. A vacant one leaves the last speed in force, a wrong one may be more than the tool can bear.

Ask for vacant, and for more than the tool may turn, and stop with an alarm."

    "0944" LongText Note "a text is longer than the control shows"
"The operator sees only the beginning of the text.

Shorten it, and put what the operator needs to know first. If the control shows more, put the number under [limits] in the machine profile."

    "0945" NoFeed Review "a cut before any feed"
"The program moves at feed, and nothing before has named one. The control uses the last feed of the program before, or stops with an alarm.

Name the feed in this block or before it."

    "0946" NoUnit Review "no unit is named"
"The program does not say whether its lengths are inches or millimetres. It runs in the unit that the program before has left.

Name the unit at the head of the program, or put `units` into the machine profile if all programs of the machine use one."

    "0947" NoSpeed Review "the spindle starts without a speed"
"The program starts the spindle, and nothing before has named a speed. The spindle turns at the last one that was named.

Name the speed in this block or before it."

    "0948" SpindleStands Review "a cut with the spindle standing"
"The program has stopped the spindle, or changed the tool, and moves at feed before the spindle turns again.

Start the spindle before the move, or make the move at rapid traverse if it does not cut."

    "0949" OldLength Review "a tool moves in Z without its length"
"The tool was changed, and Z moves before the length of the new tool is named. The control moves with the length of the tool before, or with none.

Name the length in the block of the first move in Z."

    "0950" OtherLength Review "tool and length offset differ"
"The length offset that is named has another number than the tool in the spindle. That is right where a tool has several offsets; mostly it is a slip.

Correct the number. If the shop gives tools other rows, leave this rule out for the program."

    "0951" RadiusLeftOn Review "cutter compensation is left on"
"The program ends with cutter compensation in force. What the end cancels depends on the control and its parameters; the first move of the next program may be shifted by a radius.

Cancel it on the way out of the part."

    "0952" CycleLeftOn Review "a drilling cycle is left on"
"The program ends with a drilling cycle in force. If the end does not cancel it, the first position of the next program is drilled.

Cancel the cycle after its last hole."

    "0953" FrameLeftOn Review "a rotation, scale, mirror or shift is left on"
"The program ends with turned, scaled, mirrored or shifted coordinates. If the end does not cancel them, the next program runs in them.

Cancel them when they are no longer needed."

    "0954" IncrementalLeftOn Note "the incremental mode is left on"
"The program ends in the incremental mode. A program that does not begin with the absolute mode takes its first positions as distances.

End with the absolute mode, or begin each program with it."

    "0955" LengthLeftOn Note "a tool length is left on"
"The program ends with a tool length in force. Most programs name the length of each tool after its change, so this is a matter of the shop's rules. The rule is off unless it is asked for.

Cancel the length before the end."

    "0956" ModalCallLeftOn Review "a modal call is left on"
"The program ends while a modal call is open. If the end does not close it, each move of the next program calls the macro.

End the modal call after the last move that it is meant for."
        }
    };
}

pub(super) use checks_codes;
