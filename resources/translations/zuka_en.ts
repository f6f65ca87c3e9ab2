<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
<context>
    <name>AttributeForm</name>
    <message numerus="yes">
        <source>%n feature(s)</source>
        <translation>
            <numerusform>%n feature</numerusform>
            <numerusform>%n features</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>EvaluationPanel</name>
    <message numerus="yes">
        <source>%n run(s)</source>
        <translation>
            <numerusform>%n run</numerusform>
            <numerusform>%n runs</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>OffsetForm</name>
    <message numerus="yes">
        <source>%n pair(s), off by {each} px</source>
        <translation>
            <numerusform>%n pair, off by {each} px</numerusform>
            <numerusform>%n pairs, off by {each} px</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>ProjectCheckForm</name>
    <message numerus="yes">
        <source>%n file(s) damaged.</source>
        <translation>
            <numerusform>%n file damaged.</numerusform>
            <numerusform>%n files damaged.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n file(s) repaired; nothing is damaged any more.</source>
        <translation>
            <numerusform>%n file repaired; nothing is damaged any more.</numerusform>
            <numerusform>%n files repaired; nothing is damaged any more.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n file(s) checked: nothing is damaged.</source>
        <translation>
            <numerusform>%n file checked: nothing is damaged.</numerusform>
            <numerusform>%n files checked: nothing is damaged.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>ProjectTree</name>
    <message numerus="yes">
        <source>{name}: %n image(s)</source>
        <translation>
            <numerusform>{name}: %n image</numerusform>
            <numerusform>{name}: %n images</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>Quitting</name>
    <message numerus="yes">
        <source>%n job(s) are not finished.</source>
        <translation>
            <numerusform>%n job is not finished.</numerusform>
            <numerusform>%n jobs are not finished.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>ReviewPanel</name>
    <message numerus="yes">
        <source>%n left</source>
        <translation>
            <numerusform>%n left</numerusform>
            <numerusform>%n left</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n candidate(s) wait for a decision.</source>
        <translation>
            <numerusform>%n candidate wait for a decision.</numerusform>
            <numerusform>%n candidates wait for a decision.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Accept line: %n</source>
        <translation>
            <numerusform>Accept line: %n</numerusform>
            <numerusform>Accept line: %n</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Reject line: %n</source>
        <translation>
            <numerusform>Reject line: %n</numerusform>
            <numerusform>Reject line: %n</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Accept %n</source>
        <translation>
            <numerusform>Accept %n</numerusform>
            <numerusform>Accept %n</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>RunChooser</name>
    <message numerus="yes">
        <source>%n run(s)</source>
        <translation>
            <numerusform>%n run</numerusform>
            <numerusform>%n runs</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n left</source>
        <translation>
            <numerusform>%n left</numerusform>
            <numerusform>%n left</numerusform>
        </translation>
    </message>
</context>
</TS>
