//! The catalogue. Everything that is said of a code anywhere (`macroglot
//! explain`, `docs/diagnostics.md`, SARIF rules) comes from its row here.
//!
//! Codes are grouped by the part of the line that finds them: 01 text and
//! syntax, 02 dialects and machine profiles, 03 lowering, 04 legalization,
//! 05 emission, 06 libraries and projects, 07 the command line, 08 emulated
//! controls and verification, 09 checks. A number is never used again.

use super::Severity;

macro_rules! codes {
    ($($number:literal $name:ident $severity:ident $title:literal $page:literal)*) => {
        /// The code of a diagnostic.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = $title] $name,)*
        }

        /// Every code, in order.
        pub const ALL: &[Code] = &[$(Code::$name),*];

        impl Code {
            /// Its number as users see it: `MG0101`.
            pub const fn number(self) -> &'static str {
                match self { $(Code::$name => concat!("MG", $number),)* }
            }

            /// How grave it is.
            pub const fn severity(self) -> Severity {
                match self { $(Code::$name => Severity::$severity,)* }
            }

            /// What it is, in a few words.
            pub const fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)* }
            }

            /// Its page: what happened, why it matters, what to do.
            pub const fn page(self) -> &'static str {
                match self { $(Code::$name => $page,)* }
            }
        }
    };
}

impl Code {
    /// The code with this number (`MG0101`, case and the letters MG left free).
    pub fn find(number: &str) -> Option<Code> {
        let digits = number.trim().trim_start_matches(['M', 'm', 'G', 'g']);
        ALL.iter().copied().find(|code| &code.number()[2..] == digits)
    }
}

impl serde::Serialize for Code {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.number())
    }
}

codes! {
    // ---- 01: text and syntax ----
    "0101" Unreadable Error "block cannot be read"
"The block does not follow the grammar of its control, so nothing is known of what it does. Its bytes are kept. A program with such a block is refused, because a conversion would have to leave it out.

Correct the block; the place shown is where reading stopped."

    "0111" NestedComment Error "comment inside a comment"
"A comment ends at its first `)`. A second `(` inside it opens nothing, so the control reads what follows the first `)` as code.

Use other signs inside the comment."

    "0112" UnbalancedBracket Error "brackets do not match"
"A `[` is never closed, or a `]` closes nothing. The text does not show which expression was meant.

Add or remove the bracket shown."

    "0114" BracketDepth Error "too many nested brackets"
"The control takes only so many levels of brackets, functions included. One more is an alarm.

Compute part of the expression in an earlier block."

    "0115" TooManyDigits Error "too many digits"
"The number has more digits than the control takes. Leading zeros count, the decimal point does not.

Write fewer digits, or compute the value from two constants."

    "0116" NotInteger Error "number must be whole"
"This word takes a whole number only. The control rounds the value of a variable or a bracket there, but stops with an alarm at a written fraction.

Write a whole number, or put the value in brackets if rounding is meant."

    "0117" VariableProgramNumber Error "program or sequence number from a variable"
"O and N take a written number only. Every other letter may have a variable or an expression.

Write the number."

    "0118" NullAssigned Error "#0 cannot be written"
"#0 is always vacant. It can be read, but an assignment to it is an alarm.

Assign to another variable."

    "0119" LoopNumber Error "loop number is not 1, 2 or 3"
"DO and END take the numbers 1, 2 and 3. Loops that are not nested may share a number.

Use a number that is free here, or jumps."

    "0120" AtanDivision Error "second argument of ATAN is not in brackets"
"A slash after ATAN[..] makes it the function of two arguments. The second must stand in brackets too, or the control stops with an alarm.

Write `ATAN[a]/[b]` for the angle of a point, `[ATAN[a]]/b` for a quotient."

    "0121" RelationalSign Error "sign in place of a comparison word"
"These controls compare with EQ, NE, GT, GE, LT and LE. The signs = < > have no such meaning.

Write the word."

    "0122" DivisionByZero Error "division by zero"
"The divisor is the constant 0. The control stops with an alarm here.

Correct the divisor."

    "0123" FunctionDomain Error "argument is outside the function's domain"
"The function has no value for this constant. The control stops with an alarm here.

Correct the argument."

    "0124" MacroCallNotAlone Error "other codes in the block of a macro call"
"A block that calls a macro with G65 or G66 takes nothing but the call and its arguments.

Put the other words into a block of their own."

    "0125" ArgumentBeforeCall Error "argument stands before the macro call"
"G65 and G66 must stand before their arguments. A word before them is not an argument.

Move the call to the head of the block."

    "0126" RoundBrackets Error "round brackets are comments"
"Parentheses hold comments here, also inside expressions. The control does not compute what is in them.

Write `[` and `]`."

    "0128" BareIndirection Error "## needs brackets"
"A variable that gives the number of a variable stands in brackets.

Write `#[#1]`."

    "0129" LoopWordSlip Error "D and a zero in place of DO"
"The word after WHILE is DO, with the letter O. With a zero it is a D word, and the control stops with an alarm.

Write `DO`."

    "0130" NothingConditional Error "nothing follows the condition"
"The block ends after the condition, so the condition decides nothing.

Add the statement, or remove the condition."

    "0131" OutputFormat Error "output format is wrong"
"A value that is put out needs two digits in brackets: the places before and after the decimal point. Together they are 1 to 8.

Correct the format."

    "0132" LoopsCross Error "loops cross"
"An END closes a loop other than the innermost open one. Loops may nest; they may not overlap.

Put the ENDs in the opposite order of their DOs."

    "0133" LoopNotPaired Error "DO without END, or END without DO"
"Each DO needs an END with the same number after it, in the same program.

Add the missing one."

    "0134" JumpIntoLoop Error "jump into a loop"
"The target stands between a DO and its END, and the jump does not. A loop may be left by a jump, not entered.

Jump to the block of the DO, or build the loop from jumps."

    "0135" ModalCallNotOpen Review "G67 without G66"
"There is no modal call to cancel. A parameter of the control decides whether that is an alarm or does nothing.

Remove the G67 if no modal call of a calling program is meant."

    "0136" AlarmIfRun Review "an alarm if this statement runs"
"The statement divides by the constant 0, or gives a function a constant that it has no value for. The control stops with
an alarm if the statement runs; a condition before it decides that.

Make sure that the condition never holds, or that the alarm is meant."

    "0150" TooComplex Error "block is too long or nests too deeply to be read"
"Brackets nest deeper, or the statement or the line is longer, than any control takes. A line is read up to 262144 characters. The block is kept as it stands and not read further.

Divide the statement into steps with variables between them; give each block a line of its own."

    "0151" MixedLine Error "NC words and a macro statement on one line"
"On this control a line holds either NC words, or a `#` and a macro statement, never both.

Put the macro statement on a line of its own."

    "0152" MacroLineTooLong Review "macro line is longer than the control takes"
"A macro line of this control holds 63 characters, counting the `#`, blanks and the comment. It is not known what the control does with a longer line.

Shorten the comment, or divide the statement."

    "0153" LabelNotAlone Error "a label does not stand alone"
"A label has its line to itself: no statement, no word, and on some controls not even a comment.

Move the rest of the line to the next one."

    "0154" ExponentForm Error "number in exponent form"
"This control has no exponent form of numbers.

Write the number out: 123000 for 1.23 times ten to the fifth."

    "0155" MacroComment Error "comment sign that is an operator here"
"On a macro line `(` and `*` belong to expressions; a comment begins with an apostrophe.

Write `'` in front of the comment."

    "0156" SemicolonInMacro Error "semicolon on a macro line"
"A macro line has no semicolons. Commas divide the parts of a PRINT list.

Write a comma, or take the semicolon away."

    "0157" UnterminatedText Error "text without its closing quotation mark"
"A text stands between two quotation marks on one line. The second one is missing, so it is not known where the text ends.

Add the quotation mark."

    "0158" ConditionExpected Error "a comparison is expected"
"IF, AND, OR and NOT take a comparison. No source says what a number means there. Most often an operator was lost on the way, as in `IF V19 THEN` for `IF V1<=9 THEN`.

Write the comparison out, such as `V1<>0`."

    "0159" ComparisonAsValue Error "a comparison in place of a value"
"A comparison has no value on this control: it cannot be computed with, assigned or printed.

Use IF to choose between two assignments."

    "0160" VariableOnNcLine Error "V variable among NC words"
"NC words of this control take R variables only. Copy the V variable to an R variable on a macro line first.

Write `#R9=V1` on the line before, and `X+R9` here."

    "0161" EqualsOnNcLine Error "`=` among NC words"
"Outside macro lines an R variable is set by its sign, without `=`.

Write `R9+1.` here, or `#R9=1.` on a macro line."

    "0162" SignMissing Error "sign is missing between letter and variable"
"A word takes its value from an R variable only with a sign between the two: `X+R2`, `X-R2`. The sign multiplies.

Write the sign."

    "0163" TextBehindComment Review "text after a comment's closing bracket"
"On this control a comment runs from its opening bracket to the end of the line. Words after the closing bracket are part of the comment, and the control does not carry them out, whatever the programmer meant.

Put the comment at the end of the line, or take the words away."

    "0164" MarkMissing Review "macro statement without its `#`"
"The statement is written as at the command prompt, without the `#` that a line of a program needs.

Write `#` in front of it."

    "0167" NumberTooLarge Error "number is too large"
"A block number, program number, subscript or label number has more digits than anything on the control.

Correct the number."

    "0168" UnclosedComment Error "comment is not closed"
"A comment of this control ends at its closing bracket. The bracket is missing, so it is not known where the words begin again.

Add the bracket."

    "0169" WordWithoutValue Error "word without a value"
"An address letter needs a number or a variable after it.

Add the value, or take the letter away."

    "0170" MixedBlock Error "plain words and parametric words in one block"
"A block of this control holds words with numbers (`X10`), or words, assignments and jumps with variables (`X=V1`), not both. Only G codes stand with either.

Put the number into a variable, or divide the block."

    "0171" OneOperation Error "more than one operation in a statement"
"This control computes one operation in each assignment: two operands and one operator, or one function of one operand.

Divide the statement into steps with variables between them."

    "0172" NoBrackets Error "brackets in an expression"
"This control has no brackets in expressions; round brackets hold comments.

Divide the statement into steps with variables between them."

    "0173" UnknownFunction Error "unknown function"
"The control has no function of this name. The page of the dialect (`macroglot dialects`) lists those that it has.

Compute it from the functions that are there: the tangent as sine divided by cosine."

    "0174" ConstantInWord Error "constant in a parametric word"
"A variable follows the `=` of a word. A constant is written without `=`, and then the block may not hold parametric words.

Put the constant into a variable."

    "0175" UnshownOperand Review "no manual shows this operand"
"The manual shows a variable as the first operand of an operation and as the argument of a function. It is not known whether a constant may stand there.

Put the constant into a variable first."

    "0176" ValueNotReadable Error "address cannot be read back"
"The active value of this address cannot be read into a variable.

Keep the value in a variable of its own where it is set."

    "0177" SignedVariable Error "sign in front of a variable"
"This control does not take a sign in front of a variable.

Multiply by -1 in a step of its own: `V1=V2* -1`."

    // ---- 02: dialects and machine profiles ----
    "0201" UnconfirmedFact Review "no manual confirms this"
"The conversion depends on how a control behaves here, and no maker's text confirms it. The message names the fact and the control; `macroglot dialects` with the control's name prints the fact, and where it is from.

Check it on the machine or in its manual, then put it into the machine profile: a fact by its name in `confirm`, the answer to a question under `[behaviours]`, such as `divide.by.zero = \"alarm\"`."

    "0202" DialectTable Error "a table of `dialects/` is wrong"
"A table of facts about a control contradicts itself, names something that does not exist, or has a key that nothing reads. Nothing is converted with a table that is wrong.

Correct the row shown. `dialects/README.md` says what the columns mean."

    "0203" MachineProfile Error "the machine profile is wrong"
"The profile of a machine has a key that nothing reads, a value that its control cannot have, or names a fact that its table does not hold. A setting that is not understood would make every conversion for that machine doubtful, so nothing is converted.

Correct the line shown. `macroglot dialects` lists what a control can be set to."

    // ---- 03: lowering ----
    "0301" NotUnderstood Error "unknown meaning"
"The block can be read, but the table of its control has no meaning for this word or statement. Nothing is guessed: the program is refused.

If a machine builder defined the word, give its meaning in the machine profile."

    "0310" TargetMissing Error "no block has this label"
"A jump goes to a sequence number or a label that no block of the program has. The control would stop there with an alarm.

Correct the jump or add the label."

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
"The control reads ahead: a statement that reads a position, an input or a counter may get its value from before the last moves. The conversion reads it after they are done. If the program means that too, nothing changes.

If it does, put a wait before the statement."

    "0315" Indexer Error "sends code to the maker's indexer"
"The statement sends text to a device that only this maker's controls have. The text has no meaning elsewhere.

Program the axis directly."

    "0316" FixedSubroutine Review "calls a fixed subroutine of the maker"
"The maker keeps the subroutine in the control. It is not part of the library, so no program here shows what it does, and other makers' controls do not have it.

Write the routine as a program of the library."

    "0317" SpeedRange Review "a fraction of the spindle speed picks a belt range"
"On this control the digit after the point of a spindle speed is not part of the speed: it picks the belt range. The speed is converted without it, and the target picks the range.

Check that the target picks the same range."

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
"The block-skip sign is in a block that begins or ends a loop, or it stands twice in its block. It is not certain what the control then skips.

Put the words to be skipped into a block of their own."

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

Name a machine profile with 'machine = \"lathe\"', or with 'machine = \"mill\"' if the program is for a mill after all."

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

    "0356" LeftOut Note "text that is never run is left out"
"A test asks for what the machine's profile settles, such as the unit. Its jump always goes, or never, and nothing else comes to the text at this place. The conversion leaves that text out, with its comments.

Look at it once: if it must stay, take the line that settles the test out of the profile."

    // ---- 04: legalization ----
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

If nobody relies on the value from before power-off, nothing needs to be done. Otherwise move it by hand to a register that lasts as long as on the source."

    "0405" Conditional Review "equivalent only if this holds on your machine"
"The target does the same only if something is true that the programs do not say: what the operator does at a stop, how inputs are wired, which unit the control is set to. The message names it.

Check it on the machine. If a machine profile can state it, state it there."

    "0406" MessageCut Note "message is cut"
"The target shows fewer characters of a message than the source. The message is cut, and a comment beside it has the whole text."

    "0407" LettersReplaced Note "letters are replaced"
"A message, a line of output or a comment has letters or signs that the target is not known to show, such as accented ones. Similar ones take their place: UE for Ü, C for Ç, EUR for €. Round brackets inside a message become square ones, and a per cent sign becomes PCT. This is reported once per program, at the first of them.

Nothing needs to be done. If a letter of a message has no substitute, MG0507 says so."

    // ---- 05: emission ----
    "0501" Unmapped Error "the target has no spelling for this"
"The table of the target control has no row for something that the program needs: a code, a letter, a function, a register. Nothing is written in its place, so the program is refused.

The message names what is missing. If the machine has it, say so in its profile or in the table. If not, macroglot should have replaced it earlier: please report that."

    "0502" NestsTooDeep Error "brackets nest too deep"
"The expression needs more levels of brackets than the target control takes, counting those of functions and conditions.

Split the expression over two assignments in the source."

    "0503" NumberTooLong Error "the number has too many digits"
"The number has more digits than the target control takes, so it cannot be written without changing its value.

Round it in the source to what the machine needs."

    "0504" LineTooLong Error "the block is too long"
"The block has more characters than a line of the target control takes. Comments do not count: they get lines of their own.

Split the block in the source."

    "0505" NoSequenceNumber Error "no sequence number can be given"
"A block that a jump goes to needs a sequence number of its own. Either all numbers that the control takes are used, or two blocks need the same number, because a computed jump or a return fixes it.

Renumber the blocks of the source."

    "0506" TextUnwritable Error "the text cannot be written on the target"
"A line of output or a name has characters that the target control cannot write. The receiver would read something else.

Write it without these characters."

    "0507" MessageAltered Review "the message looks different on the target"
"A message to the operator has characters that the target control cannot write, and others take their place; or it is longer than the screen shows, and its end may be missing.

Check that the operator still understands it, or shorten it in the source."

    "0599" Internal Error "fault of macroglot itself"
"A check that macroglot makes of its own work failed: the program it was about to write breaks a rule of its intermediate form or of the target's grammar. Nothing of it was written.

Please report the program with this message."

    // ---- 06: libraries and projects ----
    "0601" OutsideLibrary Review "calls a program outside the library"
"The program calls one that is not among the converted files, or one that is refused and so not written. The call keeps its number. It is not known what the called program does: which variables it changes, which modes it leaves in force, whether it exists on the target.

Convert the whole library in one run, correct what is refused, or check the program on the target by hand."

    "0602" TwinProgram Review "two programs have one number"
"Two programs of the library have the same number. A control holds only one program of a number, so the shop loads one or the other; the conversion cannot tell which.

Convert them apart, or give one another number."

    "0603" AmbiguousCall Error "calls a number that two programs have"
"The program calls a number that two programs of the library have. The conversion cannot tell which one runs, and does not guess.

Convert the two in separate runs, each with its own callers."

    "0604" OutOfNumbers Error "no program number is free"
"A program that has no number on the source, or a subroutine that becomes a program of its own, needs a number on the target, and no number is free."

    "0605" Renumbered Note "a program gets another number"
"The number of the program is larger than the target control takes, so the program gets one that is free there. Calls in the library that name it get the new number too; `macroglot.lock` keeps it for later runs.

Whoever selects the program at the machine, or calls it from outside the library, must use the new number."

    "0606" CalleeWithdrawn Error "calls a withdrawn program"
"The conversion of the called program does not do what its source does, as runs on the emulated controls show (MG0801). It is not written, and neither are its callers: they would run something else, or stop with an alarm. Other programs of the file and of the library are written.

Look at the named program first. Once it converts, so do its callers."

    "0610" LockConflict Error "an earlier conversion has this register"
"`macroglot.lock` in the output folder keeps registers for programs that were converted before and are not part of this run. A program of this run needs one of them for itself: its variable has that number on both controls, or variables with computed numbers need a row of registers.

Delete `macroglot.lock`, and convert the files that the message names together with these, in one run."

    "0611" LockChanged Note "a variable gets another register than before"
"An earlier run chose a register that a program of the library now needs for itself. All programs that rely on the choice are part of this run, so the variable gets another one, and all of them are written anew.

Load all of the programs into the machine. If a value in the old register matters, move it by hand."

    // ---- 07: the command line ----

    // ---- 08: emulated controls and verification ----
    "0801" VerifiedDifferent Error "the conversion differs from its source"
"Source and conversion were run on their emulated controls, and they do not do the same. The message names the first difference; the certificate has the start values, both blocks and both events. The program is not written, and neither are its callers (MG0606); other programs of its file are. The certificate is `NAME.not-written.json` in the output folder.

The fault is in the conversion, in an emulated control, or in the table of a control. Please report the program with its certificate."

    "0802" NotDecided Review "verification is not complete"
"Source and conversion were run on their emulated controls, and no difference was found. But part of the program was not decided: a branch that no scenario reached, a run that did not end, a called program that is not in the library, an unconfirmed fact that mattered. The message says which.

Check the places that the message names, or add what is missing to the machine profile, and run `macroglot verify` again."

    "0803" RoundingSensitive Review "rounding may decide a comparison"
"A comparison of computed values is so close that the last digit decides it. If the target computes with fewer digits, or errs in the last one, the machine does something else. Two controls of the same make can differ here.

Add a tolerance to the comparison in the source, or round before it."

    "0804" AlarmRaised Error "the program ends in an alarm"
"The program was run on its emulated control, which stopped with an alarm here. The message has the alarm's text, and its number on the control if a source names it. If the program itself gave the number, it is shown with what the control adds to it.

If the alarm is the program's own check, run it with the values that it wants: `--set '#1=2.5'`."

    "0805" NoEnd Error "the program does not end"
"The program was run on its emulated control and used up its limit of blocks, events or time. The place shows where it was then. A loop that waits for an input, or a main program that starts again, runs for ever without a person at the machine.

Look for the loop at this place; a scenario file can set inputs. If the program is only long, raise the limit with `--steps`."

    "0806" CannotRun Error "the program cannot be run"
"The emulated control met a block that it cannot read or run, or a call of a program that it does not have.

Name the files of called programs with `--library`."

    // ---- 09: checks ----
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
