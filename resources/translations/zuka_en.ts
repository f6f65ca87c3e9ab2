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
        <name>ProjectTree</name>
        <message numerus="yes">
            <source>{name}: %n image(s)</source>
            <translation>
                <numerusform>{name}: %n image</numerusform>
                <numerusform>{name}: %n images</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>{name}: %n feature(s)</source>
            <translation>
                <numerusform>{name}: %n feature</numerusform>
                <numerusform>{name}: %n features</numerusform>
            </translation>
        </message>
    </context>
</TS>
