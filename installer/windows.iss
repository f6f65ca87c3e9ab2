; Zuka for Windows, for Inno Setup 6:  iscc installer\windows.iss
; Needs Python 3.11 to 3.13 on the machine; the set-up makes the environment in {app}\.venv.

#define Name "Zuka"
#define Version "0.1.0"

[Setup]
AppId={{6E0B0F52-6B1E-4C5E-9A43-2B7B6B0D5A11}
AppName={#Name}
AppVersion={#Version}
DefaultDirName={localappdata}\Programs\{#Name}
DefaultGroupName={#Name}
DisableProgramGroupPage=yes
LicenseFile=..\LICENSE
OutputBaseFilename=zuka-{#Version}-windows
OutputDir=..\dist
PrivilegesRequired=lowest
ArchitecturesAllowed=x64compatible
ArchitecturesInstallIn64BitMode=x64compatible
Compression=lzma2
SolidCompression=yes
WizardStyle=modern

[Languages]
Name: "ja"; MessagesFile: "compiler:Languages\Japanese.isl"
Name: "en"; MessagesFile: "compiler:Default.isl"

[CustomMessages]
ja.SettingUp=必要なパッケージを取得しています（数分かかります）
en.SettingUp=Fetching what Zuka needs (this takes some minutes)
ja.NotReady=準備に失敗しました。Python 3.11～3.13 とネットワーク接続を確認して、もう一度実行してください。
en.NotReady=The set-up failed. Check that Python 3.11 to 3.13 is installed and the network is reached, then run it again.

[Files]
Source: "..\app\*"; DestDir: "{app}\app"; Excludes: "__pycache__"; Flags: recursesubdirs
Source: "..\widgets\*"; DestDir: "{app}\widgets"; Excludes: "__pycache__"; Flags: recursesubdirs
Source: "..\processing\*"; DestDir: "{app}\processing"; Excludes: "__pycache__"; Flags: recursesubdirs
Source: "..\resources\*"; DestDir: "{app}\resources"; Excludes: "__pycache__,*.qm"; Flags: recursesubdirs
Source: "..\installer\*.py"; DestDir: "{app}\installer"
Source: "..\pyproject.toml"; DestDir: "{app}"
Source: "..\requirements.lock"; DestDir: "{app}"
Source: "..\README.md"; DestDir: "{app}"
Source: "..\LICENSE"; DestDir: "{app}"

[Icons]
Name: "{group}\{#Name}"; Filename: "{app}\.venv\Scripts\pythonw.exe"; Parameters: "-m app"; WorkingDir: "{app}"
Name: "{userdesktop}\{#Name}"; Filename: "{app}\.venv\Scripts\pythonw.exe"; Parameters: "-m app"; WorkingDir: "{app}"

[UninstallDelete]
Type: filesandordirs; Name: "{app}\.venv"
Type: filesandordirs; Name: "{app}\zuka.egg-info"
Type: files; Name: "{app}\resources\translations\*.qm"

[Code]
procedure CurStepChanged(CurStep: TSetupStep);
var
  Status: Integer;
begin
  if CurStep <> ssPostInstall then
    exit;
  WizardForm.StatusLabel.Caption := CustomMessage('SettingUp');
  if not Exec('py.exe', '-3 installer\bootstrap.py setup', ExpandConstant('{app}'),
              SW_SHOW, ewWaitUntilTerminated, Status) or (Status <> 0) then
    MsgBox(CustomMessage('NotReady'), mbError, MB_OK);
end;
