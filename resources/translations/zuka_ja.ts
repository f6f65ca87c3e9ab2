<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="ja" sourcelanguage="en">
    <context>
        <name>AttributeEditor</name>
        <message>
            <source>(several values)</source>
            <translation>（複数の値）</translation>
        </message>
        <message>
            <source>Empty this field of all selected features</source>
            <translation>選択したすべての地物でこの項目を空にします</translation>
        </message>
        <message>
            <source>YYYY-MM-DD</source>
            <translation>YYYY-MM-DD</translation>
        </message>
    </context>
    <context>
        <name>AttributeForm</name>
        <message numerus="yes">
            <source>%n feature(s)</source>
            <translation>
                <numerusform>%n 個の地物</numerusform>
            </translation>
        </message>
        <message>
            <source>Kind</source>
            <translation>種別</translation>
        </message>
        <message>
            <source>Status</source>
            <translation>状態</translation>
        </message>
        <message>
            <source>(several kinds)</source>
            <translation>（複数の種別）</translation>
        </message>
        <message>
            <source>(several values)</source>
            <translation>（複数の値）</translation>
        </message>
        <message>
            <source>Confidence</source>
            <translation>信頼度</translation>
        </message>
    </context>
    <context>
        <name>AttributePanel</name>
        <message>
            <source>Choose a feature to see what is known about it.</source>
            <translation>地物を選択すると、その属性を表示します。</translation>
        </message>
    </context>
    <context>
        <name>CatalogueWish</name>
        <message>
            <source>Use an office's catalogue</source>
            <translation>事務所のカタログを使う</translation>
        </message>
        <message>
            <source>The map uses kinds that the file doesn't have. Keep them with it?</source>
            <translation>図面で使用中の種別がこのファイルにありません。その種別を残して使用しますか。</translation>
        </message>
        <message>
            <source>Keep them</source>
            <translation>残して使用</translation>
        </message>
    </context>
    <context>
        <name>CommandPalette</name>
        <message>
            <source>Commands</source>
            <translation>コマンド</translation>
        </message>
        <message>
            <source>Type part of a name</source>
            <translation>名前の一部を入力</translation>
        </message>
    </context>
    <context>
        <name>DrawingBar</name>
        <message>
            <source>What is drawn: choose by name (Ctrl+K) or number key</source>
            <translation>作図する種別。名前（Ctrl+K）または数字キーで選びます</translation>
        </message>
        <message>
            <source>What clicks snap to (Alt+1 to Alt+7)</source>
            <translation>クリックの吸着先（Alt+1～Alt+7で切替）</translation>
        </message>
        <message>
            <source>Distance of the parallel copy; 0: where the mouse is</source>
            <translation>平行複写の距離（0はマウスの位置）</translation>
        </message>
        <message>
            <source>How much higher the copy runs: the upper edge of a curb</source>
            <translation>複写線を高くする量（縁石の上端など）</translation>
        </message>
    </context>
    <context>
        <name>EmptyPage</name>
        <message>
            <source>A recording is shown here as an image: every pixel is a laser point.</source>
            <translation>ここに計測データを画像として表示します。画素はすべてレーザ点です。</translation>
        </message>
        <message>
            <source>Import a delivery…</source>
            <translation>納品データをインポート…</translation>
        </message>
        <message>
            <source>Open a project…</source>
            <translation>プロジェクトを開く…</translation>
        </message>
    </context>
    <context>
        <name>ExportForm</name>
        <message>
            <source>Export</source>
            <translation>書き出し</translation>
        </message>
        <message>
            <source>DXF 2018 (UTF-8)</source>
            <translation>DXF 2018（UTF-8）</translation>
        </message>
        <message>
            <source>DXF 2000</source>
            <translation>DXF 2000</translation>
        </message>
        <message>
            <source>UTF-8</source>
            <translation>UTF-8</translation>
        </message>
        <message>
            <source>Shift_JIS (cp932)</source>
            <translation>Shift_JIS（cp932）</translation>
        </message>
        <message>
            <source>Unchecked candidates as well</source>
            <translation>未確認の候補も含める</translation>
        </message>
        <message>
            <source>Choose…</source>
            <translation>選択…</translation>
        </message>
        <message>
            <source>Files</source>
            <translation>ファイル</translation>
        </message>
        <message>
            <source>Folder</source>
            <translation>フォルダ</translation>
        </message>
        <message>
            <source>Version of DXF</source>
            <translation>DXFのバージョン</translation>
        </message>
        <message>
            <source>Text of DXF and CSV</source>
            <translation>DXFとCSVの文字コード</translation>
        </message>
    </context>
    <context>
        <name>FeatureFilter</name>
        <message>
            <source>Search</source>
            <translation>検索</translation>
        </message>
        <message>
            <source>Words in kinds, layers, attributes; the beginning of an id</source>
            <translation>種別・レイヤ・属性に含まれる語、またはIDの先頭</translation>
        </message>
        <message>
            <source>Kind of the features</source>
            <translation>地物の種別</translation>
        </message>
        <message>
            <source>Status of the features</source>
            <translation>地物の状態</translation>
        </message>
        <message>
            <source>Occluded</source>
            <translation>点なし頂点あり</translation>
        </message>
        <message>
            <source>Only features that have vertices without a measured point</source>
            <translation>計測点のない頂点をもつ地物だけを表示します</translation>
        </message>
        <message>
            <source>Attribute that is compared</source>
            <translation>条件にする属性</translation>
        </message>
        <message>
            <source>How the attribute is compared</source>
            <translation>属性の比較方法</translation>
        </message>
        <message>
            <source>Value</source>
            <translation>値</translation>
        </message>
        <message>
            <source>Select shown</source>
            <translation>表示中を選択</translation>
        </message>
        <message>
            <source>Select the features of all rows; with Shift in addition</source>
            <translation>表示中のすべての行の地物を選択します（Shiftで追加選択）</translation>
        </message>
        <message>
            <source>All kinds</source>
            <translation>すべての種別</translation>
        </message>
        <message>
            <source>{shown} of {total} features shown</source>
            <translation>{total}個中{shown}個の地物を表示</translation>
        </message>
        <message>
            <source>Any status</source>
            <translation>すべての状態</translation>
        </message>
        <message>
            <source>Any attribute</source>
            <translation>属性条件なし</translation>
        </message>
    </context>
    <context>
        <name>FeatureMenu</name>
        <message>
            <source>Go there</source>
            <translation>この地物へ移動</translation>
        </message>
        <message>
            <source>Select all of this kind</source>
            <translation>同じ種別をすべて選択</translation>
        </message>
        <message>
            <source>Accept</source>
            <translation>採用</translation>
        </message>
        <message>
            <source>Reject</source>
            <translation>却下</translation>
        </message>
        <message>
            <source>Make a candidate</source>
            <translation>候補に戻す</translation>
        </message>
        <message>
            <source>Delete</source>
            <translation>削除</translation>
        </message>
        <message>
            <source>Change kind to</source>
            <translation>種別の変更</translation>
        </message>
    </context>
    <context>
        <name>FeatureTable</name>
        <message>
            <source>No feature fits the filter.</source>
            <translation>条件に合う地物はありません。</translation>
        </message>
        <message>
            <source>Features appear here once something is drawn.</source>
            <translation>作図すると、ここに地物の一覧が表示されます。</translation>
        </message>
    </context>
    <context>
        <name>FileActions</name>
        <message>
            <source>Open project</source>
            <translation>プロジェクトを開く</translation>
        </message>
        <message>
            <source>Use an office's catalogue</source>
            <translation>事務所のカタログを使う</translation>
        </message>
        <message>
            <source>Catalogues (*.toml)</source>
            <translation>カタログ (*.toml)</translation>
        </message>
        <message>
            <source>Write the catalogue</source>
            <translation>カタログの書き出し</translation>
        </message>
    </context>
    <context>
        <name>ImageBar</name>
        <message>
            <source>Darker end of the contrast, percentile</source>
            <translation>コントラストの暗い側（百分位数）</translation>
        </message>
        <message>
            <source>Brighter end of the contrast, percentile</source>
            <translation>コントラストの明るい側（百分位数）</translation>
        </message>
        <message>
            <source>Whole</source>
            <translation>全体</translation>
        </message>
        <message>
            <source>Show the whole recording (Home)</source>
            <translation>計測データ全体を表示（Home）</translation>
        </message>
        <message>
            <source>One pixel of the image on one of the screen</source>
            <translation>画像の1画素を画面の1画素で表示</translation>
        </message>
        <message>
            <source>Contrast</source>
            <translation>コントラスト</translation>
        </message>
    </context>
    <context>
        <name>ImageView</name>
        <message>
            <source>Show everything</source>
            <translation>全体を表示</translation>
        </message>
        <message>
            <source>One pixel as one pixel</source>
            <translation>画像の1画素を画面の1画素で表示</translation>
        </message>
        <message>
            <source>Centre on the selection</source>
            <translation>選択位置を中央に表示</translation>
        </message>
    </context>
    <context>
        <name>ImportForm</name>
        <message>
            <source>Import a drive</source>
            <translation>走行データのインポート</translation>
        </message>
        <message>
            <source>Import</source>
            <translation>インポート</translation>
        </message>
        <message>
            <source>Add files…</source>
            <translation>ファイルを追加…</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>除外</translation>
        </message>
        <message>
            <source>Choose…</source>
            <translation>選択…</translation>
        </message>
        <message>
            <source>Point files of all scanners, the trajectory, and image lists if there are any.</source>
            <translation>全スキャナの点群ファイル、軌跡ファイルと、あれば画像一覧を指定してください。</translation>
        </message>
        <message>
            <source>Project</source>
            <translation>プロジェクト</translation>
        </message>
        <message>
            <source>Reference system</source>
            <translation>座標参照系</translation>
        </message>
        <message>
            <source>Deliveries (*.las *.laz *.ply *.pcd *.e57 *.pts *.xyz *.txt *.csv *.out *.sbet)</source>
            <translation>納品ファイル (*.las *.laz *.ply *.pcd *.e57 *.pts *.xyz *.txt *.csv *.out *.sbet)</translation>
        </message>
        <message>
            <source>Add files</source>
            <translation>ファイルの追加</translation>
        </message>
        <message>
            <source>Zuka projects (*.zuka)</source>
            <translation>Zukaプロジェクト (*.zuka)</translation>
        </message>
        <message>
            <source>The reference system must be a code such as EPSG:6677, or be left empty.</source>
            <translation>座標参照系は EPSG:6677 のようなコードで指定するか、空欄にしてください。</translation>
        </message>
    </context>
    <context>
        <name>JobsPanel</name>
        <message>
            <source>Jobs appear here while they run.</source>
            <translation>実行中のジョブがここに表示されます。</translation>
        </message>
    </context>
    <context>
        <name>LayersPanel</name>
        <message>
            <source>Search for a kind</source>
            <translation>種別を検索</translation>
        </message>
        <message>
            <source>On the map</source>
            <translation>図面にある種別</translation>
        </message>
        <message>
            <source>All other kinds</source>
            <translation>その他の種別</translation>
        </message>
        <message>
            <source>All kinds</source>
            <translation>すべての種別</translation>
        </message>
        <message>
            <source>Key that chooses this kind</source>
            <translation>この種別を選ぶキー</translation>
        </message>
        <message>
            <source>Whether features of this kind are shown</source>
            <translation>この種別の地物を表示するかどうか</translation>
        </message>
    </context>
    <context>
        <name>MainWindow</name>
        <message>
            <source>Tools</source>
            <translation>ツール</translation>
        </message>
        <message>
            <source>Zuka</source>
            <translation>Zuka（図化）</translation>
        </message>
    </context>
    <context>
        <name>MessageBar</name>
        <message>
            <source>Close this message</source>
            <translation>このメッセージを閉じる</translation>
        </message>
    </context>
    <context>
        <name>Minimap</name>
        <message>
            <source>The whole recording; click or drag to go there</source>
            <translation>計測データ全体。クリックまたはドラッグでその位置へ移動します</translation>
        </message>
    </context>
    <context>
        <name>OccludedRow</name>
        <message>
            <source>Next</source>
            <translation>次へ</translation>
        </message>
        <message>
            <source>Move the cursor to the next vertex without a measured point</source>
            <translation>計測点のない次の頂点へカーソルを移動します</translation>
        </message>
        <message>
            <source>{count} of {total} vertices without a measured point</source>
            <translation>計測点のない頂点: {total}点中{count}点</translation>
        </message>
    </context>
    <context>
        <name>ParameterForm</name>
        <message>
            <source>This tool needs no settings.</source>
            <translation>このツールに設定項目はありません。</translation>
        </message>
        <message>
            <source>{low} to {high} {unit}</source>
            <translation>{low} ～ {high} {unit}</translation>
        </message>
    </context>
    <context>
        <name>ParameterRow</name>
        <message>
            <source>Back to the default</source>
            <translation>既定値に戻す</translation>
        </message>
        <message>
            <source>None</source>
            <translation>なし</translation>
        </message>
        <message>
            <source>Choose a file</source>
            <translation>ファイルを選択</translation>
        </message>
    </context>
    <context>
        <name>ProcessingPanel</name>
        <message>
            <source>Search for a tool</source>
            <translation>ツールを検索</translation>
        </message>
        <message>
            <source>Run</source>
            <translation>実行</translation>
        </message>
    </context>
    <context>
        <name>ProjectTree</name>
        <message>
            <source>Drives appear here once a project is open.</source>
            <translation>プロジェクトを開くと、ここに走行データを表示します。</translation>
        </message>
        <message>
            <source>Drives</source>
            <translation>走行データ</translation>
        </message>
        <message>
            <source>Camera images</source>
            <translation>カメラ画像</translation>
        </message>
        <message numerus="yes">
            <source>{name}: %n image(s)</source>
            <translation>
                <numerusform>{name}: %n 枚</numerusform>
            </translation>
        </message>
        <message>
            <source>Runs</source>
            <translation>処理履歴</translation>
        </message>
        <message numerus="yes">
            <source>{name}: %n feature(s)</source>
            <translation>
                <numerusform>{name}: 地物 %n 個</numerusform>
            </translation>
        </message>
        <message>
            <source>{count} points</source>
            <translation>{count} 点</translation>
        </message>
        <message>
            <source>{size} m</source>
            <translation>{size} m</translation>
        </message>
        <message>
            <source>reference system unknown</source>
            <translation>座標参照系は不明</translation>
        </message>
        <message>
            <source>No turns of a scanner: {reason}</source>
            <translation>スキャナの回転なし: {reason}</translation>
        </message>
        <message>
            <source>{rate} turns per second, {pulses} pulses per turn</source>
            <translation>毎秒{rate}回転、1回転あたり{pulses}パルス</translation>
        </message>
    </context>
    <context>
        <name>ReferenceSystemBox</name>
        <message>
            <source>As the files say</source>
            <translation>ファイルの記載に従う</translation>
        </message>
        <message>
            <source>{code}  Plane rectangular system {zone} (JGD2011)</source>
            <translation>{code}  平面直角座標系 第{zone}系（JGD2011）</translation>
        </message>
    </context>
    <context>
        <name>ReferenceSystemForm</name>
        <message>
            <source>Reference system</source>
            <translation>座標参照系</translation>
        </message>
        <message>
            <source>Give a code such as EPSG:6677.</source>
            <translation>EPSG:6677 のようなコードを指定してください。</translation>
        </message>
    </context>
    <context>
        <name>ScenePainter</name>
        <message>
            <source>1 px = {metres:.3f} m</source>
            <translation>1 px = {metres:.3f} m</translation>
        </message>
    </context>
    <context>
        <name>SceneView</name>
        <message>
            <source>The recording appears here in three dimensions once one is open.</source>
            <translation>計測データを開くと、ここに3次元で表示します。</translation>
        </message>
        <message>
            <source>The 3D view is starting.</source>
            <translation>3Dビューを起動しています。</translation>
        </message>
        <message>
            <source>Points are being loaded.</source>
            <translation>点を読み込んでいます。</translation>
        </message>
        <message>
            <source>Along the drive</source>
            <translation>走行方向</translation>
        </message>
        <message>
            <source>From above</source>
            <translation>真上から</translation>
        </message>
        <message>
            <source>Show everything</source>
            <translation>全体を表示</translation>
        </message>
        <message>
            <source>Centre on the selection</source>
            <translation>選択位置を中央に表示</translation>
        </message>
        <message>
            <source>Shade by depth (eye-dome lighting)</source>
            <translation>奥行きの陰影（Eye-Dome Lighting）</translation>
        </message>
    </context>
    <context>
        <name>ShortcutsForm</name>
        <message>
            <source>Keyboard shortcuts</source>
            <translation>キーボードショートカット</translation>
        </message>
        <message>
            <source>Search by name, menu or key</source>
            <translation>名前・メニュー・キーで検索</translation>
        </message>
        <message>
            <source>Name</source>
            <translation>名前</translation>
        </message>
        <message>
            <source>Menu</source>
            <translation>メニュー</translation>
        </message>
        <message>
            <source>Key</source>
            <translation>キー</translation>
        </message>
        <message>
            <source>Use it here</source>
            <translation>このキーを使う</translation>
        </message>
        <message>
            <source>No key</source>
            <translation>キーなし</translation>
        </message>
        <message>
            <source>Reset this one</source>
            <translation>この項目を初期値に戻す</translation>
        </message>
        <message>
            <source>Reset all</source>
            <translation>すべて初期値に戻す</translation>
        </message>
        <message>
            <source>Save the list…</source>
            <translation>一覧を保存…</translation>
        </message>
        <message>
            <source>New key</source>
            <translation>新しいキー</translation>
        </message>
        <message>
            <source>Choose a command, then press its new key.</source>
            <translation>コマンドを選び、新しいキーを押してください。</translation>
        </message>
        <message>
            <source>This is the same in every view and can't be changed.</source>
            <translation>すべてのビューで共通の操作のため、変更できません。</translation>
        </message>
        <message>
            <source>Press the new key for: {name}</source>
            <translation>「{name}」の新しいキーを押してください。</translation>
        </message>
        <message>
            <source>Save the list</source>
            <translation>一覧を保存</translation>
        </message>
        <message>
            <source>Tables (*.csv)</source>
            <translation>表 (*.csv)</translation>
        </message>
    </context>
    <context>
        <name>StartPage</name>
        <message>
            <source>Recent projects</source>
            <translation>最近使ったプロジェクト</translation>
        </message>
        <message>
            <source>Or drop files here: a project folder, or point clouds with their trajectory and list of images.</source>
            <translation>ファイルをここにドロップすることもできます（プロジェクトフォルダ、または点群と軌跡・画像一覧）。</translation>
        </message>
        <message>
            <source>No project was opened yet.</source>
            <translation>まだプロジェクトを開いていません。</translation>
        </message>
        <message>
            <source>Remove from the list</source>
            <translation>一覧から削除</translation>
        </message>
        <message>
            <source>not found</source>
            <translation>見つかりません</translation>
        </message>
        <message>
            <source>Zuka</source>
            <translation>Zuka（図化）</translation>
        </message>
        <message>
            <source>Import a delivery…</source>
            <translation>納品データをインポート…</translation>
        </message>
        <message>
            <source>Open a project…</source>
            <translation>プロジェクトを開く…</translation>
        </message>
        <message>
            <source>Sample street</source>
            <translation>サンプル街路</translation>
        </message>
    </context>
    <context>
        <name>StatusLine</name>
        <message>
            <source>{title} {percent} %, {left} left</source>
            <translation>{title} {percent} %、残り{left}</translation>
        </message>
        <message>
            <source>{title} {percent} %</source>
            <translation>{title} {percent} %</translation>
        </message>
        <message>
            <source>reference system unknown</source>
            <translation>座標参照系は不明</translation>
        </message>
    </context>
    <context>
        <name>_JobRow</name>
        <message>
            <source>Cancel this job</source>
            <translation>このジョブを中止</translation>
        </message>
        <message>
            <source>{percent}, {left} left</source>
            <translation>{percent}、残り{left}</translation>
        </message>
        <message>
            <source>waiting</source>
            <translation>待機中</translation>
        </message>
        <message>
            <source>done</source>
            <translation>完了</translation>
        </message>
        <message>
            <source>failed</source>
            <translation>失敗</translation>
        </message>
        <message>
            <source>cancelled</source>
            <translation>中止</translation>
        </message>
    </context>
    <context>
        <name>parts.window</name>
        <message>
            <source>What to draw</source>
            <translation>作図する種別</translation>
        </message>
    </context>
</TS>
