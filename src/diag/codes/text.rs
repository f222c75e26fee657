//! Codes of 01: text and syntax.

macro_rules! text_codes {
    ($($rows:tt)*) => {
        machines_codes! { $($rows)*
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
        }
    };
}

pub(super) use text_codes;
